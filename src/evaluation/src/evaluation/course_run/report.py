"""A drive's figures, and the final table that compares each follower's latest run."""

from __future__ import annotations

import json
from pathlib import Path

from evaluation.lap import LapScorer
from evaluation.trial.report import cell, table, write_json

COLUMNS = (  # heading, key, factor, digits
    ("laps", "laps_closed", 1, 0),
    ("lap s", "mean_lap_s", 1, 1),
    ("m", "distance_m", 1, 2),
    ("RMS cm", "rms_lateral_m", 100, 1),
    ("max cm", "max_lateral_m", 100, 1),
    ("sent", "frames_sent", 1, 0),
    ("dropped", "frames_dropped", 1, 0),
    ("real time", "real_time_factor", 1, 2),
)


def summarize(drive: LapScorer, outcome: tuple[str, str]) -> dict:
    """The figures of one drive; lengths in m, times in simulated s."""
    times = [lap.time for lap in drive.laps]
    return {
        "outcome": outcome[0],
        "why": outcome[1] or None,
        "laps_wanted": drive.wanted_laps,
        "laps_closed": len(times),
        "lap_times_s": [round(time, 3) for time in times],
        "mean_lap_s": round(sum(times) / len(times), 3) if times else None,
        **_lengths(drive.total),
        "laps": [{"time_s": round(lap.time, 3), **_lengths(lap)} for lap in drive.laps],
    }


def _lengths(part: object) -> dict:
    """Distance and lateral errors (m) of a lap, or of the whole drive."""
    return {"distance_m": round(part.distance, 3), "rms_lateral_m": round(part.rms_lateral, 4),
            "max_lateral_m": round(part.max_lateral, 4)}


def write_report(folder: Path, follower: str, run: dict) -> dict[str, dict]:
    """Write report.json and <follower>.json; returns the latest run of each follower, by name."""
    write_json({"follower": follower, **run}, folder / f"{Path(follower).stem}.json")
    runs = {follower: run}
    for path in sorted(folder.glob("*.json")):
        if path.name != "report.json":
            other = _read(path)
            runs.setdefault(other.get("follower", path.stem), other)
    runs.pop(None, None)
    kept = ("outcome", *(key for _, key, *_ in COLUMNS))
    side_by_side = {name: {key: runs[name].get(key) for key in kept}
                    for name in sorted(runs) if "outcome" in runs[name]}
    write_json({"follower": follower, **run, "followers": side_by_side}, folder / "report.json")
    return side_by_side


def followers_table(runs: dict[str, dict], current: str) -> str:
    """All followers' figures, a row each; the current run's row is marked."""
    rows = [["  follower", *(heading for heading, *_ in COLUMNS), "outcome"]]
    for name, run in runs.items():
        cells = [cell(run.get(key), factor, digits) for _, key, factor, digits in COLUMNS]
        rows.append([f"{'>' if name == current else ' '} {name}", *cells, run["outcome"]])
    return table(rows, left=(0, len(COLUMNS) + 1))


def _read(path: Path) -> dict:
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return values if isinstance(values, dict) else {}
