"""One drive through a hall, as the simulator's own log of states tells it."""

from __future__ import annotations

import json
import math
import xmlrpc.client
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import rosgraph
from learning_laser import hall

from run_session.connections import look_up
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.simulator import WAFFLE, models, unpause

START_LIMIT = 120.0  # s, wall
LIMIT = 120.0  # s, simulated
TOPICS = ("/scan", "/cmd_vel")
REACHED, CONTACT, LATE = "reached", "contact", "late"


@dataclass(frozen=True)
class Drive:
    """How it went; m, s."""

    name: str
    seed: int
    outcome: str
    time: float
    distance: float  # of the way driven
    nearest: float  # from the axle's middle to a column's or wall's surface
    unanswered: int  # scans
    path: list[list[float]] = field(repr=False)  # x, y

    @property
    def passed(self) -> bool:
        """Did it arrive without a contact?"""
        return self.outcome == REACHED

    @property
    def line(self) -> str:
        """On one line."""
        return (f"{self.name}: {self.outcome} after {self.time:.1f} s and {self.distance:.1f} m,"
                f" nearest {self.nearest:.2f} m")


def bring_up(launched: Launched, world: Path, seed: int, avoider: str, state_log: Path) -> None:
    """Start all, wait until everybody is connected, and let time begin."""
    launched.start_roscore()
    launched.start("roslaunch", [
        "roslaunch", "evaluation", "avoid.launch", f"world_name:={world}", f"seed:={seed}",
        f"avoider:={avoider}", f"state_log:={state_log}", "paused:=true", "real_time_factor:=0"])
    launched.wait_for(f"model {WAFFLE}", lambda: WAFFLE in models(), START_LIMIT)
    launched.wait_for(f"who reads /scan ({avoider})", lambda: _connected(launched.master_uri),
                      START_LIMIT)
    unpause()


def watch(launched: Launched, state_log: Path) -> list[dict]:
    """The log's states up to the finish, the first contact or LIMIT."""
    states: list[dict] = []
    with state_log.open(encoding="utf-8") as file:
        while not (states and outcome(states[-1])):
            launched.wait_for("the next state", lambda: (line := file.readline())
                              and _take(states, line), START_LIMIT)
    return states


def outcome(state: dict) -> str | None:
    """What has happened by then."""
    if any({WAFFLE, "hall"} == set(pair) for pair in state["contacts"]):
        return CONTACT
    if state["poses"][WAFFLE][0] > hall.FINISH:
        return REACHED
    return LATE if state["time"] > LIMIT else None


def scored(name: str, seed: int, states: list[dict]) -> Drive:
    """The result of a drive's states."""
    path = np.array([state["poses"][WAFFLE][:2] for state in states])
    away = np.hypot(*(path[:, None] - hall.columns(seed)).transpose(2, 0, 1)) - hall.RADIUS
    nearest = min(away.min(), hall.WIDTH / 2 - np.abs(path[:, 1]).max())
    distance = float(np.hypot(*np.diff(path, axis=0).T).sum())
    return Drive(name, seed, outcome(states[-1]), round(states[-1]["time"], 2), round(distance, 3),
                 round(float(nearest), 3), states[-1]["unanswered"], path.round(4).tolist())


def _connected(master_uri: str) -> bool:
    try:
        found = look_up(master_uri, "/avoid", TOPICS)
    except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
        return False
    return all(found.publishers[topic] and found.subscribers[topic]
               and not found.missing_link(topic) for topic in TOPICS)


def _take(states: list[dict], line: str) -> bool:
    """Whether the line is a state of the robot; RunError where the log is none."""
    try:
        state = json.loads(line)
    except ValueError as error:
        raise RunError(f"the simulator's log of states: {error}") from error
    if WAFFLE not in state.get("poses", {}) or not math.isfinite(state["time"]):
        return False
    states.append(state)
    return True
