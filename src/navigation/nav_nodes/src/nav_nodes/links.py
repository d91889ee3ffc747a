"""Which one of the transforms between two frames is missing or late, by what tf2 knows of all."""

from __future__ import annotations

import re
from dataclasses import dataclass

import tf2_py

# Of one frame; read like this because a YAML reader takes 5 ms for a robot's, some 50 times a s.
FRAME = re.compile(r"^(\S+): ?\n  parent: '(.*)'\n(?:  .*\n)*?  most_recent_transform: (.*)\n",
                   re.MULTILINE)
TOGETHER = 0.25  # s; without odometry there is soon no localisation, and that is not to blame


@dataclass(frozen=True)
class Link:
    """The transform from `parent` to `child`; `newest`: its stamp, s, 0 of a static one.

    None where there never was one.
    """

    parent: str
    child: str
    newest: float | None


def known_links(buffer: tf2_py.BufferCore) -> dict[str, Link]:
    """By the child's name."""
    return {child: Link(parent, child, float(newest))
            for child, parent, newest in FRAME.findall(buffer.all_frames_as_yaml())}


def weakest(links: dict[str, Link], parent: str, child: str, chain: tuple[str, ...] = ()) -> Link:
    """What is to blame where the transform from `parent` to `child` is not to be had.

    A missing one, else the oldest, or what ended with it farther down. `chain` are the names of
    frames of which each should be known in the one before, such as ("map", "odom", "base_link").
    """
    above, below = _ancestors(links, parent), _ancestors(links, child)
    shared = next((frame for frame in below if frame in above), None)
    if shared is None:
        if parent in chain[1:] and chain[chain.index(parent) - 1] in below:  # passes it by
            return Link(chain[chain.index(parent) - 1], parent, None)
        return _missing(below[-1], parent, child, chain)
    between = [links[frame] for branch in (below, above)
               for frame in branch[:branch.index(shared)]]
    moving = [link for link in between if link.newest]
    if not moving:
        return Link(parent, child, 0.0)
    oldest = min(link.newest for link in moving)
    return next(link for link in moving if link.newest < oldest + TOGETHER)


def _missing(root: str, parent: str, child: str, chain: tuple[str, ...]) -> Link:
    """Nothing says where `root` is, the frame that all leads to from `child`.

    What is not in the chain is taken for a part of the robot, whose frame is the chain's last.
    """
    named = root if root in chain[1:] else child
    if named in chain[1:]:
        parent = chain[chain.index(named) - 1]
    elif chain and root != chain[0]:
        parent = chain[-1]
    return Link(parent, root, None)


def _ancestors(links: dict[str, Link], frame: str) -> list[str]:
    """The frame itself first."""
    found = [frame]
    while found[-1] in links and links[found[-1]].parent not in found:
        found.append(links[found[-1]].parent)
    return found
