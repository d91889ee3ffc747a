"""The square and the plaza that robots learn in, and what their scripts put into them."""

from __future__ import annotations

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.sdf import DARK, GREY, WHITE, Part, box, cylinder

THICK, HIGH = 0.15, 0.5  # m, of every wall
PLAZA_WALLS = (  # x, y of the middle, yaw; each 1 m long
    (1.0, 1.0, 0.0), (-1.5, 0.0, 1.5708), (1.2, -0.9, 1.5708), (-0.6, -1.7, 0.0),
    (-1.2, 1.85, 1.5708),
)


CORNERS = ((0.6, 0.6), (0.6, -0.6), (-0.6, 0.6), (-0.6, -0.6))  # m, of stages 2 and 3
CORNER_INERTIAL = ("<inertial><pose>0 0 0.25 0 0 0</pose><mass>20</mass><inertia><ixx>8</ixx>"
                   "<iyy>8</iyy><izz>15</izz></inertia></inertial>")  # four columns, as one body
TUNNEL = ((-1.66, -2.465), (-2.407, -2.541), (-2.182, -1.754))  # m, upstream's three columns
RED = (1.0, 0.0, 0.0)


def rim(side: float) -> list[Part]:
    """Four walls round a square whose outer faces are `side` m apart."""
    middle = (side - THICK) / 2
    places = (("north", 0, middle, 0.0), ("south", 0, -middle, 0.0),
              ("east", middle, 0, 1.5708), ("west", -middle, 0, 1.5708))
    return [Part(name, box(side, THICK, HIGH), (x, y, HIGH / 2, 0, 0, yaw), WHITE)
            for name, x, y, yaw in places]


def square() -> dict[str, bytes]:
    """4 x 4 m."""
    name = "turtlebot3_square"
    text = sdf.model(name, [sdf.link("walls", rim(4.0))])
    return sdf.model_files(name, text, "Four walls, 4 x 4 m.")


def plaza() -> dict[str, bytes]:
    """5 x 5 m with five walls of 1 m in it."""
    name = "turtlebot3_plaza"
    inner = [Part(f"inner_{i}", box(1.0, THICK, HIGH), (x, y, HIGH / 2, 0, 0, yaw), WHITE)
             for i, (x, y, yaw) in enumerate(PLAZA_WALLS, 1)]
    text = sdf.model(name, [sdf.link("walls", rim(5.0) + inner)])
    return sdf.model_files(name, text, "Walls round 5 x 5 m, and five of 1 m within.")


def columns(name: str, static: int) -> str:
    """Four columns in one link."""
    parts = [Part(f"column_{i}", cylinder(0.15, 0.5), (x, y, 0.25), WHITE)
             for i, (x, y) in enumerate(CORNERS, 1)]
    mass = "" if static else CORNER_INERTIAL
    return sdf.model(name, [sdf.link("link", parts, mass=mass)], static=static)


def goal(name: str) -> str:
    """A red square on the floor, which a robot drives over: what a learning robot looks for."""
    part = Part(name, box(0.5, 0.5, 0.001), (0, 0, 0.0005), RED, solid=False)
    return sdf.model(name, [sdf.link(name, [part])])


def put_in() -> dict[str, bytes]:
    """The models that scripts spawn by upstream's paths, or that old worlds include."""
    floor = Part("ground", box(10, 10, 0.01), (0, 0, -0.1), DARK)
    tunnel = [Part(f"column_{i}", cylinder(0.1, 0.5), (x, y, 0.25), GREY)
              for i, (x, y) in enumerate(TUNNEL, 1)]
    made = {
        "turtlebot3_square/goal_box": (goal("goal_box"), "A red square of 0.5 m on the floor."),
        "turtlebot3_goalbox": (goal("turtlebot3_goalbox"), "A red square of 0.5 m on the floor."),
        "turtlebot3_obstacle": (columns("turtlebot3_obstacle", static=1), "Stage 2's columns."),
        "turtlebot3_autorace/ground": (
            sdf.model("ground", [sdf.link("ground", [floor])]), "A dark floor, 10 x 10 m."),
        "turtlebot3_autorace/tunnel_obstacles": (
            sdf.model("tunnel_obstacles", [sdf.link("link", tunnel)]),
            "Three columns in the tunnel."),
    }
    return {path: data for folder, (text, description) in made.items()
            for path, data in sdf.model_files(folder, text, description).items()}


def arenas() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    return {**square(), **plaza(), **put_in()}
