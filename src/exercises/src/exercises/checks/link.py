"""A robot's description: the link rear_camera, fixed to base_link, and where it is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from bullet_sim.errors import SimulationError
from bullet_sim.formats.urdf.tree import read_tree
from bullet_sim.formats.xml_text import read_xml_file
from bullet_sim.pose import quaternion_from_rpy, rotate
from exercises.errors import CannotCheck, Mistake
from exercises.finding import Finding, holds, near

LINK, BASE, FOOT = "rear_camera", "base_link", "base_footprint"


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The joint must be fixed and the link at the wanted pose."""
    try:
        tree = read_tree(read_xml_file(file))
    except SimulationError as error:
        raise CannotCheck(str(error)) from error
    for name in (LINK, BASE, FOOT):
        if name not in tree.links:
            raise Mistake(f"{file}: has no link {name!r}; there are: {', '.join(tree.links)}")
    if LINK not in tree.inward:
        raise Mistake(f"{file}: no joint has {LINK!r} as its child")
    joint = tree.inward[LINK]
    yield holds(f"{LINK} on {BASE}", f"{joint.type} on {joint.parent}", f"fixed on {BASE}",
                (joint.type, joint.parent) == ("fixed", BASE))
    poses = tree.poses()
    pose = poses[FOOT].inverse() * poses[LINK]
    for axis, value in zip("xyz", pose.position, strict=True):
        yield near(f"{axis} of {LINK} in {FOOT}", value, limits[axis], limits["tolerance"], " m")
    along, wanted = (rotate(turn, (1.0, 0.0, 0.0)) for turn in (
        pose.orientation, quaternion_from_rpy(0.0, 0.0, limits["yaw"])))
    yield near(f"angle of {LINK} from looking back", 2 * math.asin(
        min(1.0, math.dist(along, wanted) / 2)), 0.0, limits["tolerance"], " rad")
