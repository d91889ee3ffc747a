#!/usr/bin/env python3
"""Writes the course model (SDF, material, texture) from its track file, reproducibly."""

import argparse
import sys
from pathlib import Path

import rospkg
from racecar_description.track.course_model import write_model
from racecar_description.track.errors import TrackError
from racecar_description.track.track_file import load_track_file


def main() -> int:
    packages = rospkg.RosPack()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--track", type=Path, help="YAML file (evaluation's tracks/course.yaml)")
    parser.add_argument("--model", type=Path,
                        help="folder to write (default: the course of learning_topic and its copy "
                             "in turtlebot3_gazebo)")
    options = parser.parse_args()
    try:
        track = options.track or Path(packages.get_path("evaluation")) / "tracks" / "course.yaml"
        models = [options.model] if options.model else [
            Path(packages.get_path(name)) / "models" / "turtlebot3_autorace" / "course"
            for name in ("learning_topic", "turtlebot3_gazebo")]
        for model in models:
            for path in write_model(load_track_file(track), model):
                print(f"{path}: {path.stat().st_size} bytes")
    except (TrackError, OSError, rospkg.ResourceNotFound) as error:
        print(f"make_course: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
