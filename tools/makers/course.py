"""The line course of learning_topic."""

from pathlib import Path

from racecar_description.track.course_model import floor_files
from racecar_description.track.track_file import load_track_file

TRACK = Path(__file__).resolve().parents[2] / "src/evaluation/tracks/course.yaml"
MODEL = "src/learning_topic/models/turtlebot3_autorace/course"


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    return {f"{MODEL}/{path}": data for path, data in floor_files(load_track_file(TRACK)).items()}
