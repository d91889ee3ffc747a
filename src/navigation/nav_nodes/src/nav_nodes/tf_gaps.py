"""Finds which transform between two frames is missing or late, from tf2's list of all frames."""

from __future__ import annotations

import re
from dataclasses import dataclass

import tf2_py

# One frame's entry; a YAML parser takes 5 ms for a robot's, and is needed some 50 times a second.
FRAME = re.compile(r"^(\S+): ?\n  parent: '(.*)'\n(?:  .*\n)*?  most_recent_transform: (.*)\n",
                   re.MULTILINE)
TOGETHER = 0.25  # s; localisation that ends this soon after odometry is not to blame


@dataclass(frozen=True)
class TfLink:
    """The transform from `parent` to `child`; `newest`: its stamp, s; 0: a static one.

    None if there never was one.
    """

    parent: str
    child: str
    newest: float | None


def known_links(buffer: tf2_py.BufferCore) -> dict[str, TfLink]:
    """Links by the child's name."""
    return {child: TfLink(parent, child, float(newest))
            for child, parent, newest in FRAME.findall(buffer.all_frames_as_yaml())}


def weakest(links: dict[str, TfLink], parent: str, child: str,
            chain: tuple[str, ...] = ()) -> TfLink:
    """The link to blame if the transform from `parent` to `child` is not available.

    A missing one, else the oldest, or one farther down that ended with it. `chain`: frames' names,
    each of which should be known in the previous one, such as ("map", "odom", "base_link").
    """
    above, below = _ancestors(links, parent), _ancestors(links, child)
    shared = next((frame for frame in below if frame in above), None)
    if shared is None:
        if parent in chain[1:] and chain[chain.index(parent) - 1] in below:  # the chain is bypassed
            return TfLink(chain[chain.index(parent) - 1], parent, None)
        return _missing(below[-1], parent, child, chain)
    between = [links[frame] for branch in (below, above)
               for frame in branch[:branch.index(shared)]]
    moving = [link for link in between if link.newest]
    if not moving:
        return TfLink(parent, child, 0.0)
    oldest = min(link.newest for link in moving)
    return next(link for link in moving if link.newest < oldest + TOGETHER)


def _missing(root: str, parent: str, child: str, chain: tuple[str, ...]) -> TfLink:
    """The missing link above `root`, the topmost known ancestor of `child`.

    A frame outside the chain counts as part of the robot, whose frame is the chain's last.
    """
    named = root if root in chain[1:] else child
    if named in chain[1:]:
        parent = chain[chain.index(named) - 1]
    elif chain and root != chain[0]:
        parent = chain[-1]
    return TfLink(parent, root, None)


def _ancestors(links: dict[str, TfLink], frame: str) -> list[str]:
    """The frame itself, then its ancestors."""
    found = [frame]
    while found[-1] in links and links[found[-1]].parent not in found:
        found.append(links[found[-1]].parent)
    return found
