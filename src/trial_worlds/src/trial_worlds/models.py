"""Yards and people as SDF, for the simulator and as worlds to look at."""

from __future__ import annotations

from trial_worlds.crossing import PERSON_HEIGHT, PERSON_RADIUS, ROOM
from trial_worlds.yard import RADIUS, Yard

HEIGHT, THICKNESS = 0.5, 0.1  # m, of cylinders and walls
PERSON_TOPIC = "person/cmd_vel"


def yard_model(yard: Yard) -> str:
    """A static model of all the yard's cylinders."""
    shape = f"<cylinder><radius>{RADIUS:.5f}</radius><length>{HEIGHT}</length></cylinder>"
    return _static("yard", [(f"{x:.5f} {y:.5f} {HEIGHT / 2} 0 0 0", shape)
                            for x, y in yard.cylinders])


def room_model() -> str:
    """The four walls of the room in which a person crosses."""
    (left, right), (low, high) = ROOM
    middle_x, middle_y, height = (left + right) / 2, (low + high) / 2, HEIGHT / 2
    along = f"<box><size>{right - left:g} {THICKNESS} {HEIGHT}</size></box>"
    across = f"<box><size>{THICKNESS} {high - low:g} {HEIGHT}</size></box>"
    return _static("yard", [(f"{middle_x:g} {low:g} {height} 0 0 0", along),
                            (f"{middle_x:g} {high:g} {height} 0 0 0", along),
                            (f"{left:g} {middle_y:g} {height} 0 0 0", across),
                            (f"{right:g} {middle_y:g} {height} 0 0 0", across)])


def person_model() -> str:
    """A cylinder that is moved by commands on PERSON_TOPIC; it floats, so nothing slows it."""
    shape = (f"<geometry><cylinder><radius>{PERSON_RADIUS}</radius>"
             f"<length>{PERSON_HEIGHT}</length></cylinder></geometry>")
    return (
        '<sdf version="1.6"><model name="person"><link name="body">'
        f"<pose>0 0 {PERSON_HEIGHT / 2 + 0.01} 0 0 0</pose><gravity>false</gravity>"
        "<inertial><mass>70</mass><inertia><ixx>20</ixx><ixy>0</ixy><ixz>0</ixz><iyy>20</iyy>"
        "<iyz>0</iyz><izz>2</izz></inertia></inertial>"
        f'<collision name="body">{shape}</collision><visual name="body">{shape}</visual></link>'
        '<plugin name="walk" filename="libgazebo_ros_planar_move.so">'
        f"<commandTopic>{PERSON_TOPIC}</commandTopic><odometryRate>0</odometryRate>"
        "</plugin></model></sdf>"
    )


def world(model: str) -> str:
    """A world file with one model, given as SDF, on the ground."""
    inner = model.removeprefix('<sdf version="1.6">').removesuffix("</sdf>")
    return ('<?xml version="1.0"?>\n<sdf version="1.6"><world name="default">\n'
            "<scene><shadows>0</shadows></scene>\n"
            "<include><uri>model://sun</uri></include>\n"
            "<include><uri>model://ground_plane</uri></include>\n"
            f"{inner}\n</world></sdf>\n")


def _static(name: str, shapes: list[tuple[str, str]]) -> str:
    """A static model of shapes (pose, geometry)."""
    parts = "".join(
        f'<{kind} name="{number}"><pose>{pose}</pose><geometry>{shape}</geometry></{kind}>\n'
        for number, (pose, shape) in enumerate(shapes) for kind in ("collision", "visual"))
    return (f'<sdf version="1.6"><model name="{name}"><static>true</static><link name="parts">\n'
            f"{parts}</link></model></sdf>")
