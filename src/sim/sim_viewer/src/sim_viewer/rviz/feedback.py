"""Reports what a user of the page does to an interactive marker to the marker's server."""

from typing import Any

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from visualization_msgs.msg import InteractiveMarkerFeedback

from sim_viewer.context import Context
from sim_viewer.registry import Refused, operation
from sim_viewer.rviz.answers import find_display
from sim_viewer.rviz.display import Display
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.displays.interactive import Interactive, namespace
from sim_viewer.rviz.displays.interactive_marker import LARGEST, InteractiveMarker, unit_pose
from sim_viewer.rviz.geometry import pose_row, row_pose
from sim_viewer.rviz.tools import Publishers

EVENTS = {name: getattr(InteractiveMarkerFeedback, name) for name in (
    "KEEP_ALIVE", "POSE_UPDATE", "MENU_SELECT", "BUTTON_CLICK", "MOUSE_DOWN", "MOUSE_UP")}
MOST_ENTRY = 2 ** 32  # ids of a menu's entries


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
