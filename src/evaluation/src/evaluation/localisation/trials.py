"""The trials: a robot anywhere, a robot carried away, a long drive, and what amcl uses."""

from __future__ import annotations

import time

import numpy as np

from evaluation.localisation.results import (
    FINDING,
    HOLD,
    KIDNAPS,
    LIMITS,
    Load,
    Tracking,
    Trial,
    right_since,
    searched,
    tracking,
)
from evaluation.localisation.rig import Rig
from evaluation.localisation.wander import wandering
from run_session.failure import RunError
from trial_worlds.ground import Ground

SETTLE = 15.0  # s, simulated, after a pose was told, until it counts
CARRIED = 2.0  # m, at least, as the crow flies
TOLD_OFF = (0.3, 0.3, 0.26)  # m along x and y, and rad, at most, of a pose that is told
PERIOD = 1.0  # s, simulated, between two looks at whether it is found
MOST_DRAWS = 1000
PARTICLES = 2000


def find(rig: Rig, ground: Ground, seed: int, number: int) -> Trial:
    """A robot somewhere in the house that knows nothing of where."""
    random = np.random.default_rng([seed, number, 0])
    place = _draw_place(ground, random)
    rig.put(place)
    rig.forget()
    return _search(rig, FINDING, number, place, random)


def kidnap(rig: Rig, ground: Ground, seed: int, number: int) -> Trial:
    """A robot that knows where it is, and is carried elsewhere while it drives."""
    random = np.random.default_rng([seed, number, 1])
    _begin_known(rig, ground, random)
    with wandering(seed, rig.may_go_on):
        _watch_for(rig, SETTLE, f"before {KIDNAPS} {number}", "driving until it is carried away")
    place = _draw_place(ground, random, rig.watch.records.true_pose)
    rig.put(place)
    return _search(rig, KIDNAPS, number, place, random)


def track(rig: Rig, ground: Ground, seed: int, seconds: float) -> Tracking:
    """A long drive; the pose it is told is off a little, and the first seconds do not count."""
    random = np.random.default_rng([seed, 0, 2])
    _begin_known(rig, ground, random)
    with wandering(seed, rig.may_go_on):
        _watch_for(rig, SETTLE, "tracking", "finding itself")
        since, before = rig.now, rig.watch.records.length
        _watch_for(rig, seconds, "tracking", "driving")
    records = rig.watch.records
    _, errors = records.errors(since)
    if not len(errors):
        raise RunError("amcl said no pose while it should have tracked the robot")
    return tracking(seconds, records.length - before, errors)


def measure_load(rig: Rig, ground: Ground, seed: int, seconds: float) -> Load:
    """What amcl uses with so many particles while simulated time goes as fast as real time."""
    rig.set_pace(1.0)
    _begin_known(rig, ground, np.random.default_rng([seed, 0, 3]))
    rig.set_particles(PARTICLES)
    with wandering(seed, rig.may_go_on):
        _watch_for(rig, SETTLE, "load", "driving off")
        began, used, wall = rig.now, rig.cpu(), time.monotonic()
        _watch_for(rig, seconds, "load", "driving")
        simulated, used = rig.now - began, rig.cpu() - used
        wall = time.monotonic() - wall
    return Load(PARTICLES, simulated, wall, 100.0 * used / simulated)


def _begin_known(rig: Rig, ground: Ground, random: np.random.Generator) -> None:
    place = _draw_place(ground, random)
    rig.put(place)
    rig.tell(place + random.uniform(-1, 1, 3) * TOLD_OFF)


def _search(rig: Rig, kind: str, number: int, place: np.ndarray,
            random: np.random.Generator) -> Trial:
    """Drives until it has been right for long enough, or can no more be in time."""
    began = looked = rig.now
    since, what, part = None, "searching", f"{kind} {number}"
    with wandering(int(random.integers(1 << 31)), rig.may_go_on):
        while rig.now - began < LIMITS[kind] + HOLD:
            rig.look(part, what)
            if rig.now - looked < PERIOD:
                continue
            looked = rig.now
            times, errors = rig.watch.records.errors(began)
            since = right_since(times, errors)
            what = "searching" if since is None else "right"
            if since is not None and times[-1] - since >= HOLD:
                break
    times, errors = rig.watch.records.errors(began)
    return searched(kind, number, tuple(np.round(place, 3).tolist()), began, times, errors,
                    len(rig.watch.records.contacts))


def _watch_for(rig: Rig, seconds: float, part: str, what: str) -> None:
    until = rig.now + seconds
    while rig.now < until:
        rig.look(part, what)


def _draw_place(ground: Ground, random: np.random.Generator,
                away_from: np.ndarray | None = None) -> np.ndarray:
    """A pose (3,) where the robot has room, in the world."""
    for _ in range(MOST_DRAWS):
        place = ground.draw_goals(1, int(random.integers(1 << 31)))[0]
        if away_from is None or np.linalg.norm(place[:2] - away_from[:2]) >= CARRIED:
            return place
    raise RunError(f"no place {CARRIED:g} m away: change the house file")
