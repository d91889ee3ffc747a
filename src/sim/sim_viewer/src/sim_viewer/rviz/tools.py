"""rviz's tools that publish: 2D Pose Estimate, 2D Nav Goal and Publish Point."""

import contextlib
import math
import threading
import time
from collections.abc import Callable
from typing import Any

import rospy
from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
)
from std_msgs.msg import Header

from sim_viewer.context import Context, Node
from sim_viewer.registry import Refused, operation
from sim_viewer.tools.clock import SharedClock
from sim_viewer.tools.names import is_topic

POSITION_VARIANCE = 0.5 * 0.5  # m^2, as rviz has it
YAW_VARIANCE = 0.06853891945200942  # rad^2: (pi / 12)^2
QUEUE = 100  # messages queued for a slow subscriber
CONNECTING = 1.0  # s to wait for subscribers, so that the first click is not lost
FARTHEST = 1e6  # m


def pose(x: float, y: float, yaw: float) -> Pose:
    """A pose on the floor, rotated by `yaw` rad."""
    return Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))


def estimate(header: Header, x: float, y: float, z: float, yaw: float) -> Any:
    """What 2D Pose Estimate publishes."""
    covariance = [0.0] * 36
    covariance[0] = covariance[7] = POSITION_VARIANCE
    covariance[35] = YAW_VARIANCE
    return PoseWithCovarianceStamped(header, PoseWithCovariance(pose(x, y, yaw), covariance))


def goal(header: Header, x: float, y: float, z: float, yaw: float) -> Any:
    """What 2D Nav Goal publishes."""
    return PoseStamped(header, pose(x, y, yaw))


def point(header: Header, x: float, y: float, z: float, yaw: float) -> Any:
    """What Publish Point publishes."""
    return PointStamped(header, Point(x, y, z))


TOOLS: dict[str, tuple[type, Callable[..., Any]]] = {
    "initial_pose": (PoseWithCovarianceStamped, estimate), "goal": (PoseStamped, goal),
    "point": (PointStamped, point)}


class Publishers:
    """A publisher for each use and topic, opened at its first use. In worker threads."""

    def __init__(self, node: Node):
        self._clock: SharedClock = node.shared(SharedClock)
        self._lock = threading.Lock()
        # Each with the time in s until which subscribers may still be connecting.
        self._publishers: dict[tuple[str, str], tuple[rospy.Publisher, float]] = {}
        self._closing = contextlib.ExitStack()

    def open(self, tool: str, topic: str) -> rospy.Publisher:
        """Get ready to publish; Refused for an unknown tool or an illegal topic name."""
        if tool not in TOOLS:
            raise Refused(f"there is no tool {tool!r:.40}; there are {', '.join(TOOLS)}")
        return self.open_topic(tool, topic, TOOLS[tool][0])

    def open_topic(self, use: str, topic: str, kind: type) -> rospy.Publisher:
        """Get ready to publish messages of a class for a use; Refused for an illegal topic name."""
        if not is_topic(topic):
            raise Refused(f"{topic[:40]!r} is not the name of a topic; /goal is one")
        key = use, rospy.resolve_name(topic)
        with self._lock:
            if not self._publishers:
                self._closing.enter_context(self._clock.held())
            if key not in self._publishers:
                made = rospy.Publisher(key[1], kind, queue_size=QUEUE)
                self._publishers[key] = made, time.monotonic() + CONNECTING
        publisher, until = self._publishers[key]
        while not publisher.get_num_connections() and time.monotonic() < until:
            time.sleep(0.02)
        return publisher

    def publish(self, tool: str, topic: str, frame: str, place: tuple[float, ...]) -> int:
        """Publish, and return the number of subscribers; `place` is x, y, z in m and yaw in rad.
        Refused as by `open`."""
        publisher = self.open(tool, topic)
        header = Header(stamp=rospy.Time.from_sec(self._clock.now()), frame_id=frame)
        publisher.publish(TOOLS[tool][1](header, *place))
        return publisher.get_num_connections()

    def close(self) -> None:
        """To be called when the node ends."""
        self._closing.close()


@operation("rviz_tool", control=True)
async def rviz_tool(context: Context, tool: str, topic: str) -> None:
    """A tool was selected: get ready to publish. Refused: unknown tool, illegal topic name."""
    await context.run_in_thread(context.node.shared(Publishers).open, tool, topic)


@operation("rviz_publish", control=True)
async def rviz_publish(context: Context, tool: str, topic: str, frame: str, x: float, y: float,
                       z: float = 0.0, yaw: float = 0.0) -> dict[str, int]:
    """Publish a pose or a point in the fixed frame, at the present time; answers with the number
    of `listeners`. Refused as `rviz_tool`, without a frame, and for places too far away."""
    if not frame:
        raise Refused("there is no fixed frame yet: choose one at the left")
    if max(map(abs, (x, y, z, yaw))) > FARTHEST:
        raise Refused(f"rviz_publish: {x:g}, {y:g}, {z:g} is farther than {FARTHEST:g} m")
    listeners = await context.run_in_thread(context.node.shared(Publishers).publish, tool, topic,
                                            frame, (x, y, z, yaw))
    return {"listeners": listeners}
