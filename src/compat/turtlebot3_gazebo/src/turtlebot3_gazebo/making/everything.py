"""All that is made here; the model `turtlebot3_world` alone is written by hand."""

from __future__ import annotations

from turtlebot3_gazebo.making.arenas import arenas, house, worlds
from turtlebot3_gazebo.making.race_worlds import courses, props, race_worlds
from turtlebot3_gazebo.making.signs import signs


def everything() -> dict[str, bytes]:
    """Path in this package -> bytes of the file."""
    models = {**arenas(), **house(), **courses(), **signs(), **props()}
    return ({f"models/{path}": data for path, data in models.items()}
            | {f"worlds/{path}": data for path, data in {**worlds(), **race_worlds()}.items()})
