"""Interactive markers, made up so that what a hand does to them can be worked out."""

from __future__ import annotations

from geometry_msgs.msg import Pose, Quaternion, Vector3
from rviz_messages import at
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerFeedback,
    InteractiveMarkerInit,
    InteractiveMarkerPose,
    InteractiveMarkerUpdate,
    Marker,
    MenuEntry,
)

TO_Z = Quaternion(0.0, 1.0, 0.0, 1.0)  # turns x to -z; of any length, as in the tutorials
BALL = 0.6  # m across


def control(mode: int, name: str = "", **fields) -> InteractiveMarkerControl:
    return InteractiveMarkerControl(name=name, interaction_mode=mode,
                                    **{"orientation": Quaternion(0.0, 0.0, 0.0, 1.0)} | fields)


def cube(size: float = 0.4, kind: int = Marker.CUBE, **fields) -> Marker:
    """Without a frame: it is meant in the control's."""
    return Marker(type=kind, scale=Vector3(size, size, size),
                  color=ColorRGBA(0.5, 0.5, 0.5, 1.0), **fields)


def handle(name: str, *controls: InteractiveMarkerControl, pose: Pose | None = None,
           frame: str = "map", **fields) -> InteractiveMarker:
    return InteractiveMarker(header=Header(frame_id=frame), name=name, scale=1.0,
                             pose=pose or at(0.0, 0.0), controls=list(controls), **fields)


def init(number: int, *markers: InteractiveMarker, server: str = "s") -> InteractiveMarkerInit:
    return InteractiveMarkerInit(server, number, list(markers))


def update(number: int, markers=(), poses=(), erases=(), server: str = "s",
           kind: int = InteractiveMarkerUpdate.UPDATE) -> InteractiveMarkerUpdate:
    return InteractiveMarkerUpdate(server, number, kind, list(markers), list(poses), list(erases))


def moved(name: str, pose: Pose, frame: str = "map") -> InteractiveMarkerPose:
    return InteractiveMarkerPose(Header(frame_id=frame), pose, name)


def scene() -> list[InteractiveMarker]:
    """One to push, in odom, which is 0.5 m to the right; one to turn, one to click, one to move,
    and one with a menu."""
    mode = InteractiveMarkerControl
    entries = [MenuEntry(id=1, title="More"), MenuEntry(id=2, parent_id=1, title="Home"),
               MenuEntry(id=3, title="Shell", command_type=MenuEntry.ROSRUN)]
    return [
        handle("pushed", control(mode.MOVE_AXIS, "along"), pose=at(-0.5, 1.0), frame="odom",
               description="push me"),
        handle("turned", control(mode.ROTATE_AXIS, "about", orientation=TO_Z),
               pose=at(2.0, -1.5)),
        handle("clicked", control(mode.BUTTON, "button", markers=[cube()]), pose=at(-2.0, -1.5),
               menu_entries=entries),
        handle("moved", control(mode.MOVE_PLANE, "plane", orientation=TO_Z, markers=[cube()]),
               pose=at(-2.0, 1.5)),
        handle("asked", control(mode.MENU, "menu", description="Options"), pose=at(0.5, -2.8),
               menu_entries=entries),
    ]


def ball(mode: int) -> InteractiveMarker:
    """One that is dragged in three dimensions, in base_link."""
    return handle("ball", control(mode, "grip", orientation=TO_Z,
                                  markers=[cube(BALL, Marker.SPHERE)]),
                  pose=at(-0.5, 1.0, 0.3, 1.0), frame="base_link")


EVENTS = {getattr(InteractiveMarkerFeedback, name): name for name in (
    "KEEP_ALIVE", "POSE_UPDATE", "MENU_SELECT", "BUTTON_CLICK", "MOUSE_DOWN", "MOUSE_UP")}
