"""Many laps in differing light, then many encounters with people: is the lane keeper any good?"""

from __future__ import annotations

from pathlib import Path

from evaluation.course_run.course_file import find_package
from evaluation.course_run.failure import RunError
from evaluation.lane.drive import Drive, draw, drive
from evaluation.lane.encounters import judge, nearest_ever
from evaluation.lane.options import TrialOptions, parse_trials
from evaluation.lane.recording import read_recording
from evaluation.lane.results import (
    LaneDrive,
    encounter_table,
    from_report,
    lap_table,
    line_of,
    read_drives,
    write_report,
)
from evaluation.lane.scenery import load_crossings
from evaluation.program import NOT_PASSED, PASSED, run_program
from evaluation.track import load_track_file

LAPS_WITH_PEOPLE = 4  # in a row; bringing up a simulator takes as long as a quarter of a lap
PEOPLE_FROM = 500  # first seed of the drives with people


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("lane_trials", lambda: _run(parse_trials(arguments)))


def driven(what: Drive, out: Path) -> LaneDrive:
    """One drive with all that is judged about it."""
    report, folder = drive(what, out)
    found = from_report(report, what.method, what.seed, draw(what.seed), what.people)
    if not what.people:
        return found
    recording = read_recording(folder / "poses.txt")
    track = load_track_file(find_package("evaluation") / "tracks" / "lane.yaml")
    met = judge(recording, load_crossings(), track.lane_width)
    nearest = round(nearest_ever(recording), 3)
    return LaneDrive(**{**vars(found), "nearest_person": nearest, "encounters": tuple(met)})


def _run(options: TrialOptions) -> int:
    options.out.mkdir(parents=True, exist_ok=True)
    path = options.out / "report.json"
    drives = read_drives(path) if options.resume else []
    others = {each.method for each in drives} - {options.method}
    if others:
        raise RunError(f"{path}: is of METHOD={others.pop()}; choose that or another --out")
    try:
        _drive_laps(options, drives, path)
        _drive_crossings(options, drives, path)
    finally:
        if drives:  # what was driven is kept, however it ended
            _show(drives)
            print(f"written to {path}", flush=True)
    laps = [each for each in drives if not each.people]
    met = [each for drive in drives for each in drive.encounters]
    good = all(each.within_limits for each in laps) and all(each.passed for each in met) and all(
        each.closed and each.kept_clear for each in drives if each.people)
    return PASSED if good else NOT_PASSED


def _drive_laps(options: TrialOptions, drives: list[LaneDrive], path: Path) -> None:
    there = {each.seed for each in drives if not each.people}
    for seed in options.seeds:
        if seed not in there:
            _add(Drive(options.method, seed, 1, people=False), options, drives, path)


def _drive_crossings(options: TrialOptions, drives: list[LaneDrive], path: Path) -> None:
    """Drives with people until so many were met; RunError if nobody ever is."""
    for number in range(max(options.crossings, 1)):
        if sum(len(each.encounters) for each in drives) >= options.crossings:
            return
        seed = PEOPLE_FROM + number
        if all(each.seed != seed for each in drives if each.people):
            _add(Drive(options.method, seed, LAPS_WITH_PEOPLE, people=True), options, drives, path)
    raise RunError(f"fewer than {options.crossings} people were met in as many drives")


def _add(what: Drive, options: TrialOptions, drives: list[LaneDrive], path: Path) -> None:
    drives.append(driven(what, options.out / "drives"))
    print(line_of(drives[-1]), flush=True)
    for each in drives[-1].encounters:
        if not each.passed:
            print(f"  not passed: {each}", flush=True)
    write_report(drives, path)


def _show(drives: list[LaneDrive]) -> None:
    laps = [each for each in drives if not each.people]
    people = [each for each in drives if each.people]
    if laps:
        print(lap_table(laps), flush=True)
    if people:
        print(f"{sum(each.closed for each in people)} of {len(people)} drives with people closed")
        print(encounter_table(people), flush=True)
