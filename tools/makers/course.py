"""The line course of learning_topic, and its copy where upstream's package has it."""

import tempfile
from pathlib import Path

from racecar_description.track.course_model import write_model
from racecar_description.track.track_file import load_track_file

TRACK = Path(__file__).resolve().parents[2] / "src/evaluation/tracks/course.yaml"
PACKAGES = ("src/learning_topic", "src/compat/turtlebot3_gazebo")
MODEL = "models/turtlebot3_autorace/course"


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    with tempfile.TemporaryDirectory() as folder:
        written = {path.relative_to(folder): path.read_bytes()
                   for path in write_model(load_track_file(TRACK), Path(folder))}
    return {f"{package}/{MODEL}/{path}": data
            for package in PACKAGES for path, data in written.items()}
