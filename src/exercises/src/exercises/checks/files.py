"""Files: a bag that a program writes, and a robot's description."""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import rosbag

from bullet_sim.errors import SimulationError
from bullet_sim.formats.urdf.tree import read_tree
from bullet_sim.formats.xml_text import read_xml_file
from bullet_sim.pose import quaternion_from_rpy, rotate
from exercises.finding import CannotCheck, Finding, Mistake, holds, near
from exercises.program import compiled

NAME = "test.bag"
LIMIT = 60  # s, wall
RUN = """import runpy, sys, time
def sleep(_):
    sys.exit("it waits: give each message its time instead")
time.sleep = sleep
runpy.run_path(sys.argv[1], run_name="__main__")
"""


def bag(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A program that writes a bag with messages at given times into its working directory.

    The bag must have the right number of messages and intervals, written without waiting.
    """
    compiled(file)
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run([sys.executable, "-c", RUN, file], cwd=folder, timeout=LIMIT,
                                  text=True, capture_output=True, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired as error:
            raise Mistake(f"{file}: not done after {LIMIT} s: write the times, do not wait") \
                from error
        if done.returncode:
            raise Mistake(f"{file}: {(done.stderr.strip() or 'it failed').splitlines()[-1]}")
        if not (Path(folder) / NAME).is_file():
            raise Mistake(f"{file}: has written no {NAME}")
        try:
            with rosbag.Bag(Path(folder) / NAME) as bag:
                times = np.array([time.to_sec() for _, _, time in bag.read_messages()])
        except rosbag.ROSBagException as error:
            raise Mistake(f"{file}: {NAME} cannot be read: {error}: is it closed?") from error
    count = round(limits["messages"])
    yield holds("messages", str(len(times)), str(count), len(times) == count)
    apart = np.diff(times) if len(times) > 1 else np.array([np.nan])
    worst = float(apart[np.abs(apart - limits["period"]).argmax()])
    yield near("time between two messages, the worst", worst, limits["period"],
               limits["tolerance"], " s")


LINK, BASE, FOOT = "rear_camera", "base_link", "base_footprint"


def link(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A robot's description: the link rear_camera, fixed to base_link, and where it is.

    The joint must be fixed and the link at the wanted pose.
    """
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
