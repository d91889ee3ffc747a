"""The square and the plaza that robots learn in: walls, and nothing else."""

from __future__ import annotations

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.sdf import WHITE, Part, box

THICK, HIGH = 0.15, 0.5  # m, of every wall
PLAZA_WALLS = (  # x, y of the middle, yaw; each 1 m long
    (1.0, 1.0, 0.0), (-1.5, 0.0, 1.5708), (1.2, -0.9, 1.5708), (-0.6, -1.7, 0.0),
    (-1.2, 1.85, 1.5708),
)


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


def arenas() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    return {**square(), **plaza()}
