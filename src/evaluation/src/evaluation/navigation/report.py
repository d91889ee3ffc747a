"""A run's figures, and its final table."""

from __future__ import annotations

import argparse
import math
from dataclasses import asdict

import numpy as np

from evaluation.navigation import score
from evaluation.navigation.driver import Way
from evaluation.navigation.score import Leg, Mapping, Navigation, Result
from evaluation.trial.report import table

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
        "limits": {"ate_m": score.MOST_ATE, "agreement": score.LEAST_AGREEMENT, "contacts": 0,
                   "localisation_m": score.MOST_OFF, "localisation_deg": score.MOST_OFF_DEG},
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
            "yes" if way.reached else way.text, f"{way.time:.1f}", f"{way.straight / speed:.1f}",
            f"{way.shortest / speed:.1f}", f"{way.driven:.2f}", f"{way.off * 100:.1f}",
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
