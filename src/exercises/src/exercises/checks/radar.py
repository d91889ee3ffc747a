"""A static transform, world -> radar, as published by the program."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import rospy
import tf2_geometry_msgs  # noqa: F401  teaches tf2 to transform a PointStamped
import tf2_ros
from geometry_msgs.msg import PointStamped

from exercises.finding import Finding, holds, near
from exercises.node import START, running

POINT = 10.0, 2.0, 3.0  # m, in the radar's frame


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The radar's point must be at the right place in the world."""
    with running(file) as until:
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer)
        there = until(lambda: buffer.can_transform("world", "radar", rospy.Time(0)), START)
        yield holds("the transform world -> radar", "there" if there else "missing", "there", there)
        if there:
            point = PointStamped()
            point.header.frame_id = "radar"
            point.point.x, point.point.y, point.point.z = POINT
            seen = buffer.transform(point, "world").point
            for axis in "xyz":
                yield near(f"{axis} of the point {POINT} in world", getattr(seen, axis),
                           limits[axis], limits["tolerance"], " m")
