"""Bags: what is in them, as the page tells, and the map that slam_gmapping_replay makes of them."""

from __future__ import annotations

import contextlib
import io
import tempfile
from pathlib import Path

import numpy as np
import rosbag
import rospy
from mutating import BINARY, spoilt
from sensor_msgs.msg import LaserScan
from sim_viewer.registry import Refused
from sim_viewer.tools.bags import contents
from target import Target
from tf2_msgs.msg import TFMessage

from gmapping import replay
from nav_nodes.messages import transform_message

SETTINGS = ("_particles:=2", "_xmin:=-3", "_xmax:=3", "_ymin:=-3", "_ymax:=3")


def _bag(compression: str) -> bytes:
    """Three scans with their transforms."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.bag"
        with rosbag.Bag(str(path), "w", compression=compression) as out:
            for second in (1, 2, 3):
                stamp = rospy.Time(second)
                scan = LaserScan(angle_increment=0.1, range_min=0.1, range_max=3.5,
                                 ranges=[1.0] * 60)
                scan.header.stamp, scan.header.frame_id = stamp, "laser"
                out.write("/tf", TFMessage([
                    transform_message((second, 0.0, 0.0), "odom", "base_link", stamp),
                    transform_message(np.zeros(3), "base_link", "laser", stamp)]), stamp)
                out.write("/scan", scan, stamp)
        return path.read_bytes()


def map_bag(path: Path) -> None:
    """As the command; what it says on stderr is the refusal."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        code = replay.main([str(path), "--map", str(path.with_suffix("")), *SETTINGS])
    if code:
        raise Refused(said.getvalue())


BAGS = spoilt([_bag(name) for name in ("none", "bz2", "lz4")], BINARY)
TARGETS = (
    Target("bag_info", "input.bag", BAGS, contents, (Refused,)),
    Target("bag_map", "input.bag", BAGS, map_bag, (Refused,)),
)
