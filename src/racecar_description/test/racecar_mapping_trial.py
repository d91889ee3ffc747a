#!/usr/bin/env python3
"""The racecar maps its track by mapping.launch, driven by its lane follower.

  racecar_mapping_trial.py OUT [--venue walled|field]

Drives a lap, saves OUT/racetrack.yaml, and scores the map and the path by the simulator's truth:
OUT/mapping.json, OUT/mapping.png. The venue: the road between two walls, or racetrack.world. Exit
code 0: within the limits below; 1: not; 2: it could not run.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from trial_picture import draw
from trial_record import localisation_error, way
from trial_session import Session, TrialError
from trial_venue import LASER, LASER_ANGLES, LASER_REACH, VENUES, Truth, prepare

from evaluation.navigate_score import map_agreement
from map_server.map_files import read_map
from nav_algorithms.poses import compose
from trial_worlds.house import visible_walls

LAP, NEAR_START = 30.0, 0.3  # m: so far at least, and then so near to where it began
LAP_LIMIT, SAVE_LIMIT = 400.0, 60.0  # s, wall
LAST_MAP = 2.5  # s, simulated: gmapping's map_update_interval and a little
SPEED = 1.0  # m/s
EVERY = 25  # of /ground_truth's poses, 2 a second: from there the walls are asked for
MOST_ATE, LEAST_AGREEMENT = 0.05, 0.95  # m; share of cells


def drive_a_lap(session: Session) -> None:
    """By the lane follower, until the car is where it began; then it stands, and the map is new."""
    session.wait(lambda: len(session.record.believed), "slam_gmapping's place of the car")
    follower = session.start("follower", "rosrun", "car_control", "lane_follow.py",
                             f"_max_speed:={SPEED}")

    def is_round() -> bool:
        truth = session.record.truth
        return way(truth) > LAP and np.hypot(*(truth[-1, 1:3] - truth[0, 1:3])) < NEAR_START

    session.wait(is_round, "a lap", LAP_LIMIT)
    session.end(follower)
    stopped = session.record.truth[-1, 0]
    session.wait(lambda: session.record.truth[-1, 0] > stopped + LAST_MAP, "the last map")


def save_map(session: Session, name: Path) -> None:
    """NAME.yaml and NAME.pgm, by map_saver."""
    rospy.wait_for_message("map", OccupancyGridMessage, SAVE_LIMIT)
    saver = session.start("map_saver", "rosrun", "map_server", "map_saver", "-f", str(name))
    session.wait(lambda: saver.process.poll() is not None, "map_saver", SAVE_LIMIT)
    if saver.process.returncode:
        raise TrialError(f"map_saver: {saver.last_lines()}")


def score(out: Path, walls: Truth, truth: np.ndarray, believed: np.ndarray,
          touched: list[tuple[float, str]]) -> dict:
    """What became of it; the map's frame is the world's, where the car began."""
    grid, _ = read_map(out / "racetrack.yaml")
    error = localisation_error(truth, believed)
    seen = visible_walls(walls.map, compose(truth[::EVERY, 1:4], LASER), LASER_ANGLES, LASER_REACH)
    agreement = map_agreement(grid, walls.map, seen)
    draw(out / "mapping.png", grid, walls.map, truth, believed, [])
    print(agreement)
    return {
        "driven_m": round(way(truth), 2), "seconds": round(float(np.ptp(truth[:, 0])), 1),
        "ate_rmse_m": round(error.ate_rmse, 4), "rmse_m": round(error.rmse, 4),
        "largest_m": round(error.largest, 4), "yaw_rmse_rad": round(error.yaw_rmse, 4),
        "occupied_near_walls": round(agreement.occupied_near_walls, 4),
        "walls_found": round(agreement.walls_found, 4),
        "contacts": len(touched), "clearance_m": round(float(
            walls.clearances(truth[:, 1:4]).min()), 3)}


def main() -> int:
    """The exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="folder of the results")
    parser.add_argument("--venue", choices=VENUES, default=VENUES[0])
    options = parser.parse_args()
    out = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    venue = prepare(options.venue, out)
    try:
        with Session(venue, "mapping", out, "keyboard:=false") as session:
            drive_a_lap(session)
            save_map(session, out / "racetrack")
            record = session.record
    except TrialError as error:
        print(error, file=sys.stderr)
        return 2
    found = {"venue": venue.name, **score(out, Truth(venue), record.truth, record.believed,
                                          record.touched)}
    (out / "mapping.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(found))
    good = (found["ate_rmse_m"] <= MOST_ATE and found["contacts"] == 0
            and min(found["occupied_near_walls"], found["walls_found"]) >= LEAST_AGREEMENT)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
