"""The line course of learning_topic."""

import tempfile
from pathlib import Path

from racecar_description.track.course_model import write_model
from racecar_description.track.track_file import load_track_file

TRACK = Path(__file__).resolve().parents[2] / "src/evaluation/tracks/course.yaml"
MODEL = "src/learning_topic/models/turtlebot3_autorace/course"


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    with tempfile.TemporaryDirectory() as folder:
        return {f"{MODEL}/{path.relative_to(folder)}": path.read_bytes()
                for path in write_model(load_track_file(TRACK), Path(folder))}
