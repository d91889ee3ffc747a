"""report.json and path.png of one case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from racecar_description.track.track_file import load_track_file

from evaluation.lap import LapScorer, Verdict, fingerprint
from evaluation.picture import path_picture, write_png
from evaluation.trial.report import write_json
from marking.case_files import PATH_PICTURE, REPORT, CaseFile

BY_TIME = "by time"  # outcome: it does not answer each image, so it has to drive in real time


def write_report(folder: Path, case: CaseFile, drive: LapScorer, violations: Sequence[str],
                 fault: str, contacts: Mapping[str, int], again: bool = False) -> dict:
    """Write both into the folder; returns the report.

    `contacts`: for each touched model, the number of state log entries with the contact.
    `again`: the case has to be driven again, in real time.
    """
    total, verdict = drive.total, drive.verdict
    why = drive.why
    if verdict is Verdict.DRIVING:
        why = f"{drive.driven_share:.0%} of the lap were driven in time"
    way = len(drive.laps) + (drive.driven_share if verdict is not Verdict.CLOSED else 0.0)
    report = {
        "outcome": "not allowed" if violations else "fault" if fault else BY_TIME if again else
                   "time is up" if verdict is Verdict.DRIVING else verdict.value,
        "violations": list(violations),
        "fault": fault,
        "why": why,
        "laps_wanted": drive.wanted_laps,
        "laps_closed": len(drive.laps),
        "lap_times_s": [round(lap.time, 3) for lap in drive.laps],
        "driven_share": round(min(way / drive.wanted_laps, 1.0), 4),
        "distance_m": round(total.distance, 3),
        "rms_lateral_m": round(total.rms_lateral, 4),
        "max_lateral_m": round(total.max_lateral, 4),
        "mean_speed_m_s": round(total.distance / total.time, 4) if total.time else 0.0,
        "contacts": dict(sorted(contacts.items())),
        "drive_sha256": fingerprint(drive),
    }
    if drive.samples:
        picture = path_picture(load_track_file(Path(case.track)), drive, report["outcome"],
                               next(iter([*violations, fault or why])))
        write_png(folder / PATH_PICTURE, picture)
    write_json(report, folder / REPORT)
    return report
