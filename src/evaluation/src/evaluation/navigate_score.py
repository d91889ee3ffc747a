"""The figures of a run, whether they are within the limits, and its final table."""

from __future__ import annotations

import argparse
import math
from dataclasses import asdict, dataclass, field
from typing import ClassVar

import numpy as np
from terminal_language import heading

from evaluation.house import Contact, Records
from evaluation.map_agreement import MapAgreement, map_agreement
from evaluation.report import table
from evaluation.trajectory_error import TrajectoryError, trajectory_error
from nav_algorithms.cells import FREE, UNKNOWN, OccupancyGrid
from run_session.failure import RunError
from trial_worlds.house import Ground, visible_walls

MOST_ATE = 0.05  # m
LEAST_AGREEMENT = 0.95  # share
MOST_OFF, MOST_OFF_DEG = 0.05, 2.0  # m and degrees, mean error of localisation
MOST_MISS, MOST_MISS_DEG = 0.2, 20.0  # m and degrees from a goal that is reported reached
MOST_UNSEEN = 1.0  # s, simulated, between two contact checks, in which it may drive 26 cm
POSE_STEP = 10  # every tenth pose is checked for what the laser saw from there


@dataclass(frozen=True)
class Way:
    """A drive to a goal; m, s simulated, rad; true values unless noted otherwise."""

    goal: tuple[float, float, float]  # in the world's frame
    reached: bool  # as reported by move_base
    text: str  # of move_base's result
    time: float
    driven: float
    straight: float  # straight-line distance
    shortest: float  # shortest collision-free path; inf: none
    off: float  # distance from the goal at the end
    off_yaw: float


@dataclass(frozen=True)
class Pace:
    """How long a part of the run took, and what its processes used."""

    simulated: float  # s
    wall: float  # s
    cpu: dict[str, float]  # percent of one core, by node; in s used in 100 simulated s

    @property
    def factor(self) -> float:
        """Simulated over wall time."""
        return self.simulated / self.wall if self.wall > 0 else 0.0


@dataclass(frozen=True, kw_only=True)
class Leg:
    """The figures of one part of the run."""

    name: ClassVar[str]  # in words
    way: ClassVar[str]  # what one of its drives leads to

    ways: list[Way]
    contacts: list[Contact]
    nearest: float  # m, smallest gap to anything
    unseen: float  # s, simulated: longest time between two contact checks
    driven: float  # m
    pace: Pace

    def common_faults(self) -> list[str]:
        """Violated limits that both parts have, in words."""
        found = []
        for number, way in enumerate(self.ways, start=1):
            name = f"{self.way} {number} ({way.goal[0]:.2f}, {way.goal[1]:.2f})"
            off_deg = np.degrees(way.off_yaw)
            if not way.reached:
                found.append(f"{name} not reached: {way.text}")
            elif way.off > MOST_MISS or off_deg > MOST_MISS_DEG:
                found.append(f"{name} called reached, but {_cm(way.off)} and {off_deg:.0f}° off")
        found += [f"{self.name}: {each.own} touched something at {each.begin:.1f} s, {each.place}"
                  for each in self.contacts]
        if self.unseen > MOST_UNSEEN:
            found.append(f"{self.name}: nobody looked for {self.unseen:.1f} s whether it touches"
                         f" something, more than {MOST_UNSEEN:g} s: this machine is too busy")
        return found


def seen_of(records: Records) -> dict:
    """The fields of a part that come from its records."""
    return dict(contacts=records.contacts, nearest=records.nearest[0],
                unseen=float(records.longest_unseen), driven=records.length)


@dataclass(frozen=True, kw_only=True)
class Mapping(Leg):
    """The mapping part."""

    name, way = "mapping", "way-point"

    trajectory: TrajectoryError
    agreement: MapAgreement
    known: float  # m^2, free

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        found = []
        if self.trajectory.ate_rmse > MOST_ATE:
            found.append(f"mapping: trajectory error {_cm(self.trajectory.ate_rmse)}, "
                         f"more than {_cm(MOST_ATE)}")
        for what, share in (("occupied cells near true walls", self.agreement.occupied_near_walls),
                            ("seen walls on the map", self.agreement.walls_found)):
            if share < LEAST_AGREEMENT:
                found.append(f"mapping: {what} {share:.1%}, less than {LEAST_AGREEMENT:.0%}")
        return found + self.common_faults()


@dataclass(frozen=True)
class Localisation:
    """Errors of the estimated pose; m and rad."""

    told: tuple[float, float] | None  # of the initial pose that was given
    found: tuple[float, float]  # after the turn on the spot
    mean: tuple[float, float]  # on the way to the goals
    largest: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Navigation(Leg):
    """The part with the goals."""

    name, way = "on the way to the goals", "goal"

    localisation: Localisation

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        off, off_deg = self.localisation.mean[0], np.degrees(self.localisation.mean[1])
        if off <= MOST_OFF and off_deg <= MOST_OFF_DEG:
            return self.common_faults()
        return [f"localisation: {_cm(off)} and {off_deg:.1f}° off in the mean, more than "
                f"{_cm(MOST_OFF)} and {MOST_OFF_DEG:g}°", *self.common_faults()]


@dataclass
class Result:
    """The results of a run, or of as much as was run before it ended."""

    map: OccupancyGrid | None = None
    map_in_world: np.ndarray = field(default_factory=lambda: np.zeros(3))
    mapping: Mapping | None = None
    navigation: Navigation | None = None
    paths: dict[str, np.ndarray] = field(default_factory=dict)  # (N, 2) m, by the run's part

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        return [fault for part in (self.mapping, self.navigation) if part for fault in part.faults]


def score_mapping(ground: Ground, built: OccupancyGrid, records: Records, angles: np.ndarray,
                  reach: float, ways: list[Way], pace: Pace) -> Mapping:
    """Compare the map with the walls that a laser with these beams (rad) and reach (m) could see.

    Raises RunError if there are no true and estimated poses of the same times.
    """
    _, believed, true = records.moments()
    if not len(true):
        raise RunError("mapping: the true pose was seen too seldom to judge the map by: this "
                       "machine is too busy; PACE=0.5 may help")
    trajectory = trajectory_error(believed, true)
    seen = visible_walls(ground.walls, true[::POSE_STEP], angles, reach)
    agreement = map_agreement(built, ground.walls, seen, trajectory.alignment)
    free = (built.cells >= FREE) & (built.cells < 50) & (built.cells != UNKNOWN)
    return Mapping(**seen_of(records), ways=ways, pace=pace, trajectory=trajectory,
                   agreement=agreement, known=float(free.sum() * built.resolution ** 2))


def localisation(told: tuple[float, float] | None, errors: np.ndarray) -> Localisation:
    """From errors (N, 2) on the way to the goals; the first one follows the turn on the spot."""
    if not len(errors):
        errors = np.full((1, 2), np.inf)
    return Localisation(told, tuple(errors[0].tolist()), tuple(errors.mean(axis=0).tolist()),
                        tuple(errors.max(axis=0).tolist()))


def _cm(length: float) -> str:
    return f"{length * 100:.1f} cm"


COLUMNS = ("goal", "x", "y", "reached", "s", "straight s", "shortest s", "m", "off cm", "off °")


def summarize(options: argparse.Namespace, outcome: tuple[str, str], result: Result) -> dict:
    """All figures; lengths in m, times in simulated s except wall_s, angles in degrees."""
    speed = options.house.max_speed
    mapping, navigation = result.mapping, result.navigation
    return {
        "outcome": outcome[0],
        "why": outcome[1] or None,
        "seed": options.seed,
        "wanted_real_time_factor": options.real_time_factor,
        "goals_wanted": options.goals,
        "goals_reached": sum(way.reached for way in navigation.ways) if navigation else 0,
        "limits": {"ate_m": MOST_ATE, "agreement": LEAST_AGREEMENT, "contacts": 0,
                   "localisation_m": MOST_OFF, "localisation_deg": MOST_OFF_DEG},
        "faults": result.faults,
        "map_in_world": [round(value, 4) for value in result.map_in_world.tolist()],
        "mapping": _mapping(mapping, speed) if mapping else None,
        "navigation": _navigation(navigation, speed) if navigation else None,
    }


def lines(options: argparse.Namespace, result: Result) -> list[str]:
    """The table of goals, and lines on map and localisation."""
    found = []
    if result.mapping:
        mapping = result.mapping
        found += [
            f"map: {mapping.agreement}",
            f"trajectory while mapping: ATE {mapping.trajectory.ate_rmse * 100:.1f} cm,"
            f" {_drove(mapping)}",
        ]
    if result.navigation:
        place = result.navigation.localisation
        found += [
            *_table(result.navigation.ways, options.house.max_speed),
            f"localisation: {_both(place.mean)} off in the mean, {_both(place.largest)} at most"
            + (f"; was told {_both(place.told)} off" if place.told else ""),
            f"driven {_drove(result.navigation)}",
        ]
    return found


def _table(ways: list[Way], speed: float) -> list[str]:
    rows = [COLUMNS]
    for number, way in enumerate(ways, start=1):
        rows.append((
            str(number), f"{way.goal[0]:.2f}", f"{way.goal[1]:.2f}",
            heading("yes") if way.reached else way.text, f"{way.time:.1f}",
            f"{way.straight / speed:.1f}", f"{way.shortest / speed:.1f}", f"{way.driven:.2f}",
            f"{way.off * 100:.1f}",
            f"{math.degrees(way.off_yaw):.1f}"))
    return table(rows, left=()).splitlines()


def _mapping(mapping: Mapping, speed: float) -> dict:
    trajectory = mapping.trajectory
    return _leg(mapping, speed, "way_points", {
        "ate_rmse_m": round(trajectory.ate_rmse, 4),
        "yaw_rmse_deg": round(math.degrees(trajectory.yaw_rmse), 3),
        "largest_m": round(trajectory.largest, 4),
        **asdict(mapping.agreement),
        "known_m2": round(mapping.known, 1),
    })


def _navigation(navigation: Navigation, speed: float) -> dict:
    place = navigation.localisation
    return _leg(navigation, speed, "goals", {
        "told_off": _error(place.told) if place.told else None,
        "found_off": _error(place.found),
        "mean_off": _error(place.mean),
        "largest_off": _error(place.largest),
    })


def _leg(leg: Leg, speed: float, ways: str, own: dict) -> dict:
    pace = leg.pace
    return {
        "simulated_s": round(pace.simulated, 1), "wall_s": round(pace.wall, 1),
        "real_time_factor": round(pace.factor, 3), "cpu_percent_of_a_core": pace.cpu,
        "distance_m": round(leg.driven, 3),
        **own,
        "nearest_m": _finite(leg.nearest, 3), "longest_unseen_s": round(leg.unseen, 2),
        "contacts": [{"own": each.own, "begin_s": round(each.begin, 2),
                      "end_s": round(each.end, 2), "place_m": each.place}
                     for each in leg.contacts],
        ways: [_way(way, speed) for way in leg.ways],
    }


def _way(way: Way, speed: float) -> dict:
    x, y, yaw = way.goal
    return {"x": round(x, 3), "y": round(y, 3), "yaw_deg": round(math.degrees(yaw), 1),
            "reached": way.reached, "text": way.text, "time_s": round(way.time, 1),
            "straight_s": round(way.straight / speed, 1),
            "shortest_s": _finite(way.shortest / speed, 1),
            "driven_m": round(way.driven, 3), "off_m": round(way.off, 3),
            "off_deg": round(math.degrees(way.off_yaw), 1)}


def _error(error: tuple[float, float]) -> dict:
    return {"m": _finite(error[0], 4), "deg": _finite(math.degrees(error[1]), 2)}


def _finite(value: float, digits: int) -> float | None:
    return round(value, digits) if np.isfinite(value) else None


def _drove(leg: Leg) -> str:
    return (f"{leg.driven:.1f} m in {leg.pace.simulated:.0f} s, touched {len(leg.contacts)},"
            f" smallest gap {leg.nearest * 100:.1f} cm")


def _both(error: tuple[float, float]) -> str:
    return f"{error[0] * 100:.1f} cm and {math.degrees(error[1]):.1f}°"
