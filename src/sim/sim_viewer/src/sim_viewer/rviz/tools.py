"""What the page publishes: rviz's tools, and what is done to interactive markers.

The tools are 2D Pose Estimate, 2D Nav Goal and Publish Point.
"""

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
from visualization_msgs.msg import InteractiveMarkerFeedback

from sim_viewer.registry import Context, Node, Refused, operation
from sim_viewer.rviz.display import Display, find_display
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.displays.interactive import Interactive, namespace
from sim_viewer.rviz.displays.interactive_marker import LARGEST, InteractiveMarker, unit_pose
from sim_viewer.rviz.geometry import pose_row, row_pose
from sim_viewer.tools.clock import SharedClock
from sim_viewer.tools.master import asked, connect
from sim_viewer.tools.names import is_topic

POSITION_VARIANCE = 0.5 * 0.5  # m^2, as rviz has it
YAW_VARIANCE = 0.06853891945200942  # rad^2: (pi / 12)^2
QUEUE = 100  # messages queued for a slow subscriber
CONNECTING = 2.0  # s to wait for subscribers, so that the first click is not lost
FARTHEST = 1e6  # m
EVENTS = {name: getattr(InteractiveMarkerFeedback, name) for name in (
    "KEEP_ALIVE", "POSE_UPDATE", "MENU_SELECT", "BUTTON_CLICK", "MOUSE_DOWN", "MOUSE_UP")}
MOST_ENTRY = 2 ** 32  # ids of a menu's entries


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


def subscriber_count(topic: str) -> int:
    """The number of subscribers that the master lists; Refused if it is gone."""
    _, subscribers, _ = asked(connect().getSystemState)
    return len(dict(subscribers).get(topic, []))


class Publishers:
    """A publisher for each use and topic, opened at its first use. In worker threads."""

    def __init__(self, node: Node):
        self._clock: SharedClock = node.shared(SharedClock)
        self._lock = threading.Lock()
        # Each with the time in s until which subscribers may still be connecting.
        self._publishers: dict[tuple[str, str], tuple[rospy.Publisher, float]] = {}
        self._closing = contextlib.ExitStack()

    def open(self, tool: str, topic: str) -> rospy.Publisher:
        """Get ready to publish; Refused for an unknown tool, an illegal topic name or a
        master that is gone."""
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
        # All that the master lists, not only the first: the page itself may be the first.
        wanted = subscriber_count(key[1]) if time.monotonic() < until else 0
        while publisher.get_num_connections() < wanted and time.monotonic() < until:
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


@operation("rviz_feedback", control=True)
async def rviz_feedback(context: Context, display: int, marker: str, control: str, event: str,
                        pose: list, point: list, entry: int = 0) -> None:
    """A control of a marker was used. `marker` is its key in the frame, `pose` 7 numbers, `point`,
    where the mouse pointer hits it, 3 or none; in m and the marker's header's frame.

    Refused for unknown displays, markers, controls and events, and for invalid numbers.
    """
    shown, found = _find(context, display, marker)
    if control not in found.control_names:
        raise Refused(f"there is no control {control!r:.40} of the marker")
    message = feedback(found, control, event, pose, point, entry)
    message.client_id = f"{rospy.get_name()}/{context.client}/{display}"
    if message.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
        shown.drawer.drag(marker, row_pose(pose_row(message.pose)))
        shown.look_soon()
    publisher = await context.run_in_thread(
        context.node.shared(Publishers).open_topic, "feedback",
        f"{namespace(shown.topic)}/feedback", InteractiveMarkerFeedback)
    await context.run_in_thread(publisher.publish, message)


@operation("rviz_menu", control=True)
async def rviz_menu(context: Context, display: int, marker: str) -> list[dict[str, Any]]:
    """The entries of a marker's menu: `id`, `parent`, `title` and whether it `works`.

    Refused for unknown displays and markers.
    """
    return _find(context, display, marker)[1].menu()


def feedback(marker: InteractiveMarker, control: str, event: str, pose: list, point: list,
             entry: int) -> InteractiveMarkerFeedback:
    """The message, without the client; Refused as `rviz_feedback` says."""
    if event not in EVENTS:
        raise Refused(f"there is no event {event!r:.40}; there are {', '.join(EVENTS)}")
    if not 0 <= entry < MOST_ENTRY:
        raise Refused(f"entry is {entry!r:.40}, which no menu has")
    place = _numbers("pose", pose, 7)
    made = InteractiveMarkerFeedback(
        header=marker.header, marker_name=marker.message.name, control_name=control,
        event_type=EVENTS[event], pose=Pose(Point(*place[:3]), Quaternion(*place[3:])),
        menu_entry_id=entry, mouse_point_valid=bool(point))
    if point:
        made.mouse_point = Point(*_numbers("point", point, 3))
    try:
        unit = unit_pose(made.pose)
    except Problem as problem:
        raise Refused(f"pose: {problem}") from None
    made.pose.orientation = Quaternion(*unit.orientation)
    return made


def _find(context: Context, display: int, marker: str) -> tuple[Display, InteractiveMarker]:
    shown = find_display(context, display)
    if not isinstance(shown.drawer, Interactive):
        raise Refused(f"display {display} shows no interactive markers")
    found = shown.drawer.find(marker)
    if found is None:
        raise Refused(f"there is no marker {marker!r:.40}")
    return shown, found


def _numbers(name: str, values: list[Any], count: int) -> list[float]:
    if len(values) != count or not all(
            isinstance(one, (int, float)) and not isinstance(one, bool) and abs(one) <= LARGEST
            for one in values):
        raise Refused(f"{name} is {values!r:.40}, which are not {count} numbers up to {LARGEST:g}")
    return [float(one) for one in values]
