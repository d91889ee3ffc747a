"""The figures of a run as report.json has them; how well its map fits; limits; the final table.

Lengths in m, times in simulated s except wall_s, angles in degrees; None: not finite.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields

import numpy as np
from terminal_language import heading

from evaluation.house import Records
from evaluation.live import Outcome
from evaluation.report import cell, table_of
from evaluation.trajectory_error import trajectory_error
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from nav_algorithms.likelihood_field import distances
from nav_algorithms.poses import invert, transform_points
from run_session.failure import RunError
from trial_worlds.house import Ground, visible_walls

MOST_ATE = 0.05  # m
LEAST_AGREEMENT = 0.95  # share
MOST_OFF, MOST_OFF_DEG = 0.05, 2.0  # m and degrees, mean error of localisation
MOST_MISS, MOST_MISS_DEG = 0.2, 20.0  # m and degrees from a goal that is reported reached
MOST_UNSEEN = 1.0  # s, simulated, between two contact checks, in which it may drive 26 cm
LEAST_OF_THE_HOUSE = 0.5  # share of a map's walls that are the house's; another world's has 0.05
POSE_STEP = 10  # every tenth pose is checked for what the laser saw from there
WAYS = {"mapping": ("way_points", "mapping", "way-point"),
        "goals": ("goals", "on the way to the goals", "goal")}  # key; part and goal in words
COLUMNS = {
    "goal": lambda way: str(way["number"]),
    "x": lambda way: cell(way["x"], digits=2), "y": lambda way: cell(way["y"], digits=2),
    "reached": lambda way: heading("yes") if way["reached"] else way["text"],
    "s": lambda way: cell(way["time_s"]), "straight s": lambda way: cell(way["straight_s"]),
    "shortest s": lambda way: f"{_known(way['shortest_s']):.1f}",
    "m": lambda way: cell(way["driven_m"], digits=2),
    "off cm": lambda way: cell(way["off_m"], 100), "off °": lambda way: cell(way["off_deg"])}


@dataclass(frozen=True)
class MapAgreement:
    """Shares, 0 to 1. Near means: in the same cell of the other grid, or in one of 8 around it."""

    occupied_near_walls: float  # share of the built map's occupied cells near a true wall
    walls_found: float          # share of the true wall cells seen that are near an occupied cell
    occupied_cells: int         # of the built map
    wall_cells: int             # of the true map, seen

    def __str__(self) -> str:
        return (f"{self.occupied_near_walls:.1%} of the map's {self.occupied_cells} occupied cells "
                f"lie within one cell of a true wall; {self.walls_found:.1%} of the "
                f"{self.wall_cells} true wall cells that were seen are on the map within one cell")


def map_agreement(built: OccupancyGrid, truth: OccupancyGrid, seen: np.ndarray | None = None,
                  built_in_truth: np.ndarray = np.zeros(3),
                  occupied_from: int = 65) -> MapAgreement:
    """Compare a built map with true_map's; a share of nothing is 0.

    `seen`, bool of the truth's shape (visible_walls), says which walls the laser could see; the
    default is walls next to known cells of the built map, which is less strict: a wall that was
    seen but left unknown on both sides does not count. `built_in_truth` (3,) is the pose of the
    built map's frame in the truth's. Cells of at least `occupied_from` percent are occupied.
    """
    occupied = built.cells >= occupied_from
    walls = truth.cells == OCCUPIED
    if seen is None:
        known = built.cells != UNKNOWN
        seen = _are_near(truth, walls, built, known, invert(built_in_truth))
    else:
        seen = walls & seen
    right = _are_near(built, occupied, truth, walls, built_in_truth)
    found = _are_near(truth, seen, built, occupied, invert(built_in_truth))
    return MapAgreement(_share(right, occupied), _share(found, seen), int(occupied.sum()),
                        int(seen.sum()))


def _are_near(grid: OccupancyGrid, which: np.ndarray, other: OccupancyGrid, wanted: np.ndarray,
              grid_in_other: np.ndarray) -> np.ndarray:
    """Which of the cells `which` of `grid` are near one of `wanted` of `other`, bool."""
    chosen = np.argwhere(which)
    cells = other.cells_of(transform_points(grid_in_other, grid.centres_of(chosen)))
    inside = other.contains(cells)
    near = np.zeros(which.shape, bool)
    hit = (distances(wanted.astype(np.uint8)) < 1.5)[tuple(cells[inside].T)]  # cells, or next to it
    near[tuple(chosen[inside][hit].T)] = True
    return near


def _share(some: np.ndarray, all_of_them: np.ndarray) -> float:
    return float(some.sum() / all_of_them.sum()) if all_of_them.any() else 0.0


@dataclass
class Result:
    """The results of a run, or of as much as was run before it ended."""

    map: OccupancyGrid | None = None
    map_in_world: np.ndarray = field(default_factory=lambda: np.zeros(3))
    mapping: dict | None = None  # the figures of this part
    navigation: dict | None = None
    paths: dict[str, np.ndarray] = field(default_factory=dict)  # (N, 2) m, by the run's part

    @property
    def parts(self) -> list[dict]:
        """The figures of the parts that were run."""
        return [part for part in (self.mapping, self.navigation) if part]

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        return ((_mapping_faults(self.mapping) if self.mapping else [])
                + (_navigation_faults(self.navigation) if self.navigation else []))


def way(goal: Sequence[float], end: Sequence[float], reached: bool, text: str,
        **figures: float | None) -> dict:
    """A drive to a goal that ended there (x, y, yaw in the world); `text` of move_base's result."""
    x, y, yaw = goal
    off_yaw = math.remainder(end[2] - yaw, math.tau)
    return {"x": round(x, 3), "y": round(y, 3), "yaw_deg": round(math.degrees(yaw), 1),
            "reached": reached, "text": text, **figures,
            "off_m": round(math.dist(end[:2], (x, y)), 3),
            "off_deg": round(math.degrees(abs(off_yaw)), 1)}


def seen_of(records: Records) -> dict:
    """The figures of a part that come from its records."""
    return {"distance_m": round(records.length, 3), "nearest_m": finite(records.nearest[0], 3),
            "longest_unseen_s": round(float(records.longest_unseen), 2),
            "contacts": [{"own": each.own, "begin_s": round(each.begin, 2),
                          "end_s": round(each.end, 2), "place_m": each.place}
                         for each in records.contacts]}


def mapping_figures(ground: Ground, built: OccupancyGrid, records: Records, angles: np.ndarray,
                    reach: float) -> tuple[dict, np.ndarray]:
    """Compare the map with the walls that a laser with these beams (rad) and reach (m) could see.

    Also the pose (3,) of the map in the world. Raises RunError if there are no true and estimated
    poses of the same times.
    """
    _, believed, true = records.moments()
    if not len(true):
        raise RunError("mapping: the true pose was seen too seldom to judge the map by: this "
                       "machine is too busy; PACE=0.5 may help")
    trajectory = trajectory_error(believed, true)
    seen = visible_walls(ground.walls, true[::POSE_STEP], angles, reach)
    agreement = map_agreement(built, ground.walls, seen, trajectory.alignment)
    free = (built.cells >= FREE) & (built.cells < 50) & (built.cells != UNKNOWN)
    return {"ate_rmse_m": round(trajectory.ate_rmse, 4),
            "yaw_rmse_deg": round(math.degrees(trajectory.yaw_rmse), 3),
            "largest_m": round(trajectory.largest, 4), **asdict(agreement),
            "known_m2": round(float(free.sum() * built.resolution ** 2), 1),
            }, trajectory.alignment


def mismatch(ground: Ground, built: OccupancyGrid, map_in_world: np.ndarray) -> str | None:
    """A line about a map that is plainly not one of this house; else None."""
    share = map_agreement(built, ground.walls, built_in_truth=map_in_world).occupied_near_walls
    if share >= LEAST_OF_THE_HOUSE:
        return None
    return (f"the map does not fit this house: only {share:.0%} of its walls are where the house "
            "has one. Was it made in another world? Without MAP= this run makes its own")


def localisation(told: Sequence[float] | None, errors: np.ndarray) -> dict:
    """From errors (N, 2), m and rad, on the way to the goals: the first follows the turn on the
    spot. `told`: that of the initial pose that was given."""
    if not len(errors):
        errors = np.full((1, 2), np.inf)
    return {"told_off": _error(told) if told else None, "found_off": _error(errors[0]),
            "mean_off": _error(errors.mean(axis=0)), "largest_off": _error(errors.max(axis=0))}


def finite(value: float, digits: int) -> float | None:
    """The rounded value; None of one that JSON does not have."""
    return round(float(value), digits) if np.isfinite(value) else None


def _error(error: Sequence[float]) -> dict:
    return {"m": finite(error[0], 4), "deg": finite(math.degrees(error[1]), 2)}


def _known(value: float | None) -> float:
    return math.inf if value is None else value


def _mapping_faults(mapping: dict) -> list[str]:
    found = []
    if mapping["ate_rmse_m"] > MOST_ATE:
        found.append(f"mapping: trajectory error {_cm(mapping['ate_rmse_m'])}, "
                     f"more than {_cm(MOST_ATE)}")
    for what, share in (("occupied cells near true walls", mapping["occupied_near_walls"]),
                        ("seen walls on the map", mapping["walls_found"])):
        if share < LEAST_AGREEMENT:
            found.append(f"mapping: {what} {share:.1%}, less than {LEAST_AGREEMENT:.0%}")
    return found + _common_faults(mapping, *WAYS["mapping"])


def _navigation_faults(navigation: dict) -> list[str]:
    off, off_deg = map(_known, navigation["mean_off"].values())
    found = [f"localisation: {_cm(off)} and {off_deg:.1f}° off in the mean, more than "
             f"{_cm(MOST_OFF)} and {MOST_OFF_DEG:g}°"
             ] if off > MOST_OFF or off_deg > MOST_OFF_DEG else []
    return found + _common_faults(navigation, *WAYS["goals"])


def _common_faults(part: dict, ways: str, name: str, goal: str) -> list[str]:
    """Violated limits that both parts have, in words."""
    found = []
    for number, each in enumerate(part[ways], start=1):
        there = f"{goal} {number} ({each['x']:.2f}, {each['y']:.2f})"
        if not each["reached"]:
            found.append(f"{there} not reached: {each['text']}")
        elif each["off_m"] > MOST_MISS or each["off_deg"] > MOST_MISS_DEG:
            found.append(f"{there} called reached, but {_cm(each['off_m'])} and"
                         f" {each['off_deg']:.0f}° off")
    found += [f"{name}: {each['own']} touched something at {each['begin_s']:.1f} s,"
              f" {each['place_m']}" for each in part["contacts"]]
    if (unseen := part["longest_unseen_s"]) > MOST_UNSEEN:
        found.append(f"{name}: nobody looked for {unseen:.1f} s whether it touches"
                     f" something, more than {MOST_UNSEEN:g} s: this machine is too busy")
    return found


def summarize(options: argparse.Namespace, outcome: Outcome, result: Result) -> dict:
    """All figures."""
    return {
        "outcome": outcome.word,
        "why": outcome.why or None,
        "seed": options.seed,
        "wanted_real_time_factor": options.real_time_factor,
        "goals_wanted": options.goals,
        "goals_reached": reached(result),
        "limits": {"ate_m": MOST_ATE, "agreement": LEAST_AGREEMENT, "contacts": 0,
                   "localisation_m": MOST_OFF, "localisation_deg": MOST_OFF_DEG},
        "faults": result.faults,
        "map_in_world": [round(value, 4) for value in result.map_in_world.tolist()],
        "mapping": result.mapping,
        "navigation": result.navigation,
    }


def reached(result: Result) -> int:
    """How many goals were reached."""
    return sum(each["reached"] for each in (result.navigation or {"goals": []})["goals"])


def lines(result: Result) -> list[str]:
    """The table of goals, and lines on map and localisation."""
    found = []
    if mapping := result.mapping:
        agreement = MapAgreement(**{each.name: mapping[each.name] for each in fields(MapAgreement)})
        found += [f"map: {agreement}",
                  f"trajectory while mapping: ATE {mapping['ate_rmse_m'] * 100:.1f} cm",
                  ": ".join(("driven while mapping", _drove(mapping)))]
    if place := result.navigation:
        rows = [{"number": number, **each} for number, each in enumerate(place["goals"], start=1)]
        told = place["told_off"]
        found += [
            *table_of(COLUMNS, rows, left=()).splitlines(),
            f"localisation: {_both(place['mean_off'])} off in the mean,"
            f" {_both(place['largest_off'])} at most"
            + (f"; was told {_both(told)} off" if told else ""),
            f"driven: {_drove(place)}"]
    return found


def _drove(part: dict) -> str:
    return (f"{part['distance_m']:.1f} m in {part['simulated_s']:.0f} s, touched"
            f" {len(part['contacts'])}, smallest gap {_known(part['nearest_m']) * 100:.1f} cm")


def _both(error: dict) -> str:
    return f"{_known(error['m']) * 100:.1f} cm and {_known(error['deg']):.1f}°"


def _cm(length: float) -> str:
    return f"{length * 100:.1f} cm"
