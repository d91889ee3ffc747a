#!/usr/bin/env python3
"""The racecar drives to one place after the other by navigation.launch.

  racecar_goals_trial.py OUT [--venue walled|field] [--map FILE|drawn] [--goals FILE]

MAP is OUT/racetrack.yaml, as racecar_mapping_trial.py saves it, unless it is given; `drawn` is the
map that belongs to the track. Writes OUT/goals.json and OUT/goals.png. Exit code 0: all reached,
and no wall touched; 1: not; 2: it could not run.
"""

import argparse
import json
import sys
from pathlib import Path

import actionlib
import numpy as np
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from trial_picture import draw
from trial_record import localisation_error, turns_of_direction, way
from trial_session import Session, TrialError
from trial_venue import VENUES, Truth, Venue, prepare

from map_server.map_files import read_map
from nav_algorithms.poses import wrap_angle
from nav_nodes.messages import stamped_pose

GOALS = Path(__file__).with_name("racecar_goals.yaml")
LIMIT = 200.0  # s, wall, for one goal
ENDED = (GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.REJECTED, GoalStatus.PREEMPTED)
MOST_OFF, MOST_TURNED = 0.15, 0.2  # m, rad: the planner's tolerance, and what localisation may add


def pose_of_goal(goal: dict) -> np.ndarray:
    """(x, y, yaw) of an entry of racecar_goals.yaml."""
    return np.array([goal["x"], goal["y"], np.radians(goal["degrees"])])


def drive_to(session: Session, client: actionlib.SimpleActionClient, goal: dict,
             walls: Truth) -> dict:
    """One goal, and what became of it by the simulator's truth."""
    record, wanted = session.record, pose_of_goal(goal)
    before, contacts, plans = len(record.truth), len(record.touched), record.plans
    client.send_goal(MoveBaseGoal(stamped_pose(wanted, "map", rospy.Time.now())))
    if not session.comes(lambda: client.get_state() in ENDED, LIMIT):
        client.cancel_goal()
        session.wait(lambda: client.get_state() in ENDED, f"the end of {goal['name']}")
    truth = record.truth[before:]
    place, error = truth[-1, 1:4], localisation_error(truth, record.believed)
    return {
        "name": goal["name"], "text": client.get_goal_status_text(),
        "reached": client.get_state() == GoalStatus.SUCCEEDED,
        "off_m": round(float(np.hypot(*(place[:2] - wanted[:2]))), 3),
        "turned_rad": round(float(abs(wrap_angle(place[2] - wanted[2]))), 3),
        "seconds": round(float(np.ptp(truth[:, 0])), 1), "driven_m": round(way(truth), 2),
        "turns_of_direction": turns_of_direction(truth), "plans": record.plans - plans,
        "localisation_rmse_m": round(error.rmse, 3),
        "localisation_largest_m": round(error.largest, 3),
        "contacts": len(record.touched) - contacts,
        "clearance_m": round(float(walls.clearances(truth[:, 1:4]).min()), 3)}


def is_good(found: dict, goal: dict, narrow: bool) -> bool:
    """Reached as the simulator has it, nothing touched; in a narrow road turned as one must."""
    return bool(found["reached"] and not found["contacts"] and found["off_m"] <= MOST_OFF
                and found["turned_rad"] <= MOST_TURNED
                and (not narrow or found["turns_of_direction"] >= goal["least_turns"]))


def drive(venue: Venue, out: Path, map_file: Path, goals: list[dict]) -> dict:
    """All goals; the report. Raises TrialError where it could not run."""
    walls = Truth(venue)
    with Session(venue, "navigation", out, f"map_file:={map_file}") as session:
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        session.wait(lambda: client.wait_for_server(rospy.Duration(0.01)), "move_base")
        session.wait(lambda: len(session.record.believed), "amcl's place of the car")
        found = []
        for goal in goals:
            found.append(drive_to(session, client, goal, walls))
            found[-1]["good"] = is_good(found[-1], goal, venue.name == "walled")
            print(json.dumps(found[-1]), flush=True)
        truth, believed = session.record.truth, session.record.believed
    error = localisation_error(truth, believed)
    grid, _ = read_map(map_file)
    draw(out / "goals.png", grid, walls.map, truth, believed, [pose_of_goal(g) for g in goals])
    return {"venue": venue.name, "goals": found, "driven_m": round(way(truth), 2),
            "seconds": round(float(np.ptp(truth[:, 0])), 1),
            "localisation_rmse_m": round(error.rmse, 4),
            "localisation_largest_m": round(error.largest, 4)}


def main() -> int:
    """The exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="folder of the results")
    parser.add_argument("--venue", choices=VENUES, default=VENUES[0])
    parser.add_argument("--map", default="", help="YAML of map_server, or: drawn")
    parser.add_argument("--goals", type=Path, default=GOALS, help="YAML; racecar_goals.yaml")
    options = parser.parse_args()
    out = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    venue = prepare(options.venue, out)
    map_file = (venue.drawn_map if options.map == "drawn"
                else Path(options.map or out / "racetrack.yaml").resolve())
    try:
        found = drive(venue, out, map_file, yaml.safe_load(options.goals.read_text("utf-8")))
    except TrialError as error:
        print(error, file=sys.stderr)
        return 2
    (out / "goals.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    return 0 if all(goal["good"] for goal in found["goals"]) else 1


if __name__ == "__main__":
    sys.exit(main())
