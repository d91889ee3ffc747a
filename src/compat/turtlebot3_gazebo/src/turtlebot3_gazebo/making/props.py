"""What a race's mission puts up and takes away: lights, a crossing's bar, a parked robot."""

from __future__ import annotations

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.sdf import DARK, WHITE, Part, box, cylinder, sphere

LIGHT = (1.39, -1.57)  # m, x and y of the traffic light
LAMPS = {  # height in m, colour
    "red": (0.11, (1.0, 0.0, 0.0)), "green": (0.21, (0.0, 1.0, 0.0)),
    "yellow": (0.31, (1.0, 1.0, 0.0)),
}
BAR = (-1.72, 0.56)  # m, x and y of the crossing
BAR_LONG, BAR_HIGH = 0.36, 0.12  # m
BURGER_INERTIAL = ("<inertial><pose>0 0 0.07 0 0 0</pose><mass>1</mass><inertia><ixx>0.0035</ixx>"
                   "<iyy>0.0035</iyy><izz>0.0035</izz></inertia></inertial>")


def lamp(colour: str) -> str:
    """The lamp that is lit: a glowing ball round the dark one that stands in the world."""
    height, rgb = LAMPS[colour]
    part = Part("lamp", sphere(0.046), sdf.ORIGIN, rgb, solid=False, glows=True)
    return sdf.model(f"traffic_light_{colour}", [sdf.link("link", [part], (*LIGHT, height))])


def bar_down() -> str:
    parts = [Part("red", box(BAR_LONG / 3, 0.02, 0.03), sdf.ORIGIN, (0.9, 0.1, 0.1)),
             *(Part(name, box(BAR_LONG / 3, 0.02, 0.03), (x, 0, 0), WHITE)
               for name, x in (("west", -BAR_LONG / 3), ("east", BAR_LONG / 3)))]
    return sdf.model("traffic_bar_down", [sdf.link("link", parts, (*BAR, BAR_HIGH))])


def bar_up() -> str:
    """Upright over the eastern post."""
    parts = [Part("red", box(0.03, 0.02, BAR_LONG / 3), sdf.ORIGIN, (0.9, 0.1, 0.1)),
             *(Part(name, box(0.03, 0.02, BAR_LONG / 3), (0, 0, z), WHITE)
               for name, z in (("low", -BAR_LONG / 3), ("high", BAR_LONG / 3)))]
    place = (BAR[0] + BAR_LONG / 2 + 0.03, BAR[1], BAR_HIGH + BAR_LONG / 2)
    return sdf.model("traffic_bar_up", [sdf.link("link", parts, place)])


def bar_posts() -> str:
    """The link that stands in the world all the time, its origin in the bar's middle."""
    parts = [Part(name, box(0.03, 0.03, BAR_HIGH), (x, 0, -BAR_HIGH / 2), DARK)
             for name, x in (("west", -BAR_LONG / 2 - 0.03), ("east", BAR_LONG / 2 + 0.03))]
    return sdf.link("link", parts)


def burger() -> str:
    """A robot to be parked: its mission writes <static>1</static> over the 0."""
    parts = [Part("body", box(0.14, 0.14, 0.13), (-0.032, 0, 0.075), DARK),
             Part("wheel_left", cylinder(0.033, 0.018), (0, 0.08, 0.033, 1.5708, 0, 0), DARK),
             Part("wheel_right", cylinder(0.033, 0.018), (0, -0.08, 0.033, 1.5708, 0, 0), DARK),
             Part("laser", cylinder(0.035, 0.04), (-0.032, 0, 0.175), (0.3, 0.3, 0.3)),
             Part("caster", sphere(0.01), (-0.081, 0, 0.01), DARK)]
    return sdf.model("turtlebot3_burger", [sdf.link("base", parts, mass=BURGER_INERTIAL)], static=0)


def props() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    texts = {f"traffic_light_{colour}": (lamp(colour), f"The {colour} lamp, lit.")
             for colour in LAMPS}
    texts |= {"traffic_bar_down": (bar_down(), "The crossing's bar, closed."),
              "traffic_bar_up": (bar_up(), "The crossing's bar, open."),
              "turtlebot3_burger": (burger(), "A burger to be parked.")}
    files: dict[str, bytes] = {}
    for folder in ("turtlebot3_autorace", "turtlebot3_autorace_2020"):
        for name, (text, description) in texts.items():
            files |= sdf.model_files(f"{folder}/{name}", text, description)
    return files
