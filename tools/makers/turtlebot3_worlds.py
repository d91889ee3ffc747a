"""Worlds and models of turtlebot3_gazebo, all but `turtlebot3_world`, which is written by hand."""

from __future__ import annotations

from turtlebot3_arenas import arenas, house, worlds
from turtlebot3_race import courses, props, race_worlds
from turtlebot3_signs import signs

PACKAGE = "src/compat/turtlebot3_gazebo"


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    made = {"models": {**arenas(), **house(), **courses(), **signs(), **props()},
            "worlds": {**worlds(), **race_worlds()}}
    return {f"{PACKAGE}/{folder}/{path}": data
            for folder, inside in made.items() for path, data in inside.items()}
