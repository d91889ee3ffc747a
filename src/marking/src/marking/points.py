"""Computes points from a case's report, and the reasons for lost points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from marking.rules import Points


def points_of(drive: Mapping, points: Points) -> tuple[float, list[str]]:
    """Points of one case, and a line for each loss; `drive` is a case's report.json."""
    if drive["violations"]:
        return 0.0, [f"{points.most:g} points: {', '.join(drive['violations'])}"]
    if drive["fault"]:
        return 0.0, [f"{points.most:g} points: {drive['fault']}"]
    closed = drive["laps_closed"] >= drive["laps_wanted"]
    share = 1.0 if closed else drive["driven_share"]
    rows = [(points.finish, share, drive["why"] or "")]
    # Points for closeness and speed are scaled by how far the car came.
    line = _share(drive["rms_lateral_m"], points.line_best_m, points.line_worst_m)
    rows.append((points.line, line * share,
                 f"{drive['rms_lateral_m'] * 100:.1f} cm RMS beside the line"
                 f" (all points at {points.line_best_m * 100:g} cm)"))
    speed = _share(drive["mean_speed_m_s"], points.speed_best_m_s, points.speed_worst_m_s)
    rows.append((points.speed, speed * share,
                 f"{drive['mean_speed_m_s']:.3f} m/s on average"
                 f" (all points at {points.speed_best_m_s:g} m/s)"))
    lost = [f"{most * (1 - share):.1f} points: {why}" for most, share, why in rows
            if round(most * (1 - share), 1) > 0]
    return round(sum(most * share for most, share, _ in rows), 2), lost


def mean(points: Sequence[float]) -> float:
    """Mean points of a submission's cases."""
    return round(sum(points) / len(points), 2) if points else 0.0


def _share(value: float, best: float, worst: float) -> float:
    """1 at `best` or better, 0 at `worst` or worse, linear between."""
    if best == worst:
        return float(value <= best)
    return min(max((worst - value) / (worst - best), 0.0), 1.0)
