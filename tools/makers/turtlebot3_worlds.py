"""Worlds and models of turtlebot3_gazebo, all but `turtlebot3_world`, which is written by hand.

Each build makes them: CMakeLists.txt of the package runs it, docker/entrypoint.sh for a container
over the host's source, and conftest.py where there are none yet.
"""

from __future__ import annotations

from pathlib import Path

from turtlebot3_arenas import arenas, house, worlds
from turtlebot3_race import courses, props, race_worlds
from turtlebot3_signs import signs

PACKAGE = "src/compat/turtlebot3_gazebo"
LESSON = Path(__file__).resolve().parents[2] / "src/learning_topic/models"


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    made = {"models": {**arenas(), **house(), **courses(), **signs(), **props(), **line_course()},
            "worlds": {**worlds(), **race_worlds()}}
    return {f"{PACKAGE}/{folder}/{path}": data
            for folder, inside in made.items() for path, data in inside.items()}


def sources() -> list[Path]:
    """What is copied, and the folders in which there may be more of it."""
    return [path for path in (LESSON, *LESSON.rglob("*")) if "__pycache__" not in path.parts]


def line_course() -> dict[str, bytes]:
    """The course of the line-follower tutorial, where upstream's package has it too."""
    return {str(path.relative_to(LESSON)): path.read_bytes()
            for path in LESSON.glob("turtlebot3_autorace/course/**/*") if path.is_file()}
