#!/usr/bin/env python3
"""Writes lane_keeping's world and ground from the track, crossings and scenery files."""

import argparse
import sys
from pathlib import Path

import rospkg
from lane_keeping.settings import SettingsError
from lane_keeping.world.files import write_world
from lane_keeping.world.scenery import load_crossings, load_scenery
from racecar_description.track.errors import TrackError
from racecar_description.track.track_file import load_track_file


def main() -> int:
    packages = rospkg.RosPack()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--track", type=Path, help="YAML file (tracks/lane.yaml of evaluation)")
    parser.add_argument("--crossings", type=Path, help="YAML file (config/crossings.yaml)")
    parser.add_argument("--scenery", type=Path, help="YAML file (config/lane_scenery.yaml)")
    parser.add_argument("--no-shade", dest="shade", action="store_false", help="no shade")
    parser.add_argument("--out", type=Path, metavar="DIR",
                        help="where worlds/ and models/ go (lane_keeping)")
    options = parser.parse_args()
    try:
        track = options.track or Path(packages.get_path("evaluation")) / "tracks" / "lane.yaml"
        paths = write_world(load_track_file(track), load_crossings(options.crossings),
                            load_scenery(options.scenery),
                            options.out or Path(packages.get_path("lane_keeping")), options.shade)
        for path in paths:
            print(f"{path}: {path.stat().st_size} bytes")
    except (SettingsError, TrackError, OSError, rospkg.ResourceNotFound) as error:
        print(f"make_lane: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
