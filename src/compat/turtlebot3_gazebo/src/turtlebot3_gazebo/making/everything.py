"""All that is made here; the model `turtlebot3_world` alone is written by hand."""

from __future__ import annotations

from turtlebot3_gazebo.making.arenas import arenas
from turtlebot3_gazebo.making.courses import courses
from turtlebot3_gazebo.making.house import house
from turtlebot3_gazebo.making.props import props
from turtlebot3_gazebo.making.race_worlds import race_worlds
from turtlebot3_gazebo.making.signs import signs
from turtlebot3_gazebo.making.worlds import worlds


def everything() -> dict[str, bytes]:
    """Path in this package -> bytes of the file."""
    models = {**arenas(), **house(), **courses(), **signs(), **props()}
    return ({f"models/{path}": data for path, data in models.items()}
            | {f"worlds/{path}": data for path, data in {**worlds(), **race_worlds()}.items()})
