#!/usr/bin/env python3
"""Writes lane_keeping's world and its ground from track, crossings and scenery files."""

import argparse
import sys
from pathlib import Path

from evaluation.lane.scenery import load_crossings, load_scenery
from evaluation.lane.world import write_world
from evaluation.session.failure import RunError
from evaluation.session.resources import find_package
from evaluation.track import TrackError, load_track_file


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--track", type=Path, help="YAML file (tracks/lane.yaml)")
    parser.add_argument("--crossings", type=Path, help="YAML file (lane_keeping's)")
    parser.add_argument("--scenery", type=Path, help="YAML file (config/lane_scenery.yaml)")
    parser.add_argument("--no-shade", dest="shade", action="store_false", help="paint no shade")
    parser.add_argument("--out", type=Path, metavar="DIR",
                        help="where worlds/ and models/ go (lane_keeping)")
    options = parser.parse_args()
    try:
        track = options.track or find_package("evaluation") / "tracks" / "lane.yaml"
        paths = write_world(load_track_file(track), load_crossings(options.crossings),
                            load_scenery(options.scenery),
                            options.out or find_package("lane_keeping"), options.shade)
        for path in paths:
            print(f"{path}: {path.stat().st_size} bytes")
    except (RunError, TrackError, OSError) as error:
        print(f"make_lane: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
