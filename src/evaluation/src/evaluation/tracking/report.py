"""The figures of a tracking drive, and its summary."""

from __future__ import annotations

import math

import numpy as np
from ai_robot_tracking.scenes.start import Start

from evaluation.tracking.score import BAND, SETTLED, TrackScorer


def summarize(drive: TrackScorer, start: Start) -> dict:
    """The figures that only tracking drives have; m, simulated s."""
    errors, settled = drive.judged_errors(), drive.judged_errors(SETTLED)
    return {
        "outcome": drive.outcome, "good": drive.good,
        "wanted_distance_m": drive.task.wanted, "band_m": BAND,
        "start": {"x": round(start.x, 3), "y": round(start.y, 3),
                  "yaw_deg": round(math.degrees(start.yaw), 1)},
        "approach_s": _rounded(drive.approach, 2),
        "kept_s": round(len(errors) and drive.elapsed - drive.approach, 2),
        "left_at_s": _rounded(drive.left_at, 2),
        "rms_error_m": _rounded(np.sqrt(np.mean(errors**2)), 4) if len(errors) else None,
        "max_error_m": _rounded(np.max(np.abs(errors)), 4) if len(errors) else None,
        "max_error_settled_m": _rounded(np.max(np.abs(settled)), 4) if len(settled) else None,
        "share_within_band": (
            round(float(np.mean(np.abs(errors) <= BAND)), 4) if len(errors) else None),
        "hidden": [{"begin_s": round(each.begin, 2), "found_after_s": _rounded(each.found_after, 2)}
                   for each in drive.hidings],
        "least_gap_m": _rounded(drive.least_gap, 3),
        "distance_m": round(drive.distance, 3)}


def lines(report: dict) -> list[str]:
    """The summary for people to read."""
    found = [f"{report['tracker']}, scene {report['scene']}, seed {report['seed']}: "
             f"{report['outcome']}"]
    near = "never" if report["approach_s"] is None else f"after {report['approach_s']:.1f} s"
    found.append(f"near the cylinder {near}; {report['distance_m']:.2f} m driven in "
                 f"{report['simulated_s']:.1f} s; smallest gap "
                 f"{report['least_gap_m'] * 100:.0f} cm")
    if report["rms_error_m"] is not None:
        found.append(f"beside {report['wanted_distance_m']:g} m: RMS "
                     f"{report['rms_error_m'] * 100:.1f} cm, at most "
                     f"{report['max_error_m'] * 100:.1f} cm ({_cm(report['max_error_settled_m'])} "
                     f"after {SETTLED:g} s), within {BAND:g} m "
                     f"{report['share_within_band']:.1%} of the time")
    for each in report["hidden"]:
        after = each["found_after_s"]
        found.append(f"hidden at {each['begin_s']:.1f} s for 3 s: " + (
            "not found again" if after is None else f"found again after {after:.1f} s"))
    return found


def _cm(value: float | None) -> str:
    return "-" if value is None else f"{value * 100:.1f} cm"


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None or not math.isfinite(value) else round(float(value), digits)
