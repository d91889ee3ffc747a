"""The trials from beginning to end: drive by drive, print, write, draw."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

from evaluation.bench.ros_run import RosRun
from evaluation.course_run.failure import RunError
from evaluation.course_run.processes import Family
from evaluation.program import NOT_PASSED, PASSED, chart_writer, run_program
from evaluation.yards.crossing import draw_crossing
from evaluation.yards.drive import Way, past_person, through_yard
from evaluation.yards.options import Options, parse_options
from evaluation.yards.results import (
    CROSSINGS,
    YARDS,
    Drive,
    drive_line,
    passed,
    read_drives,
    summarize,
    table,
    write_report,
)
from evaluation.yards.rig import Rig
from evaluation.yards.sdf import world, yard_model
from evaluation.yards.sheet import write_sheets
from evaluation.yards.yard import draw_yard


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("navigation_trials", lambda: _run(parse_options(arguments)))


def _run(options: Options) -> int:
    write_chart = chart_writer("evaluation.yards.chart")  # what is missing is said at once
    try:
        (options.out / "drives").mkdir(parents=True, exist_ok=True)
        (options.out / "worlds").mkdir(exist_ok=True)
    except OSError as error:
        raise RunError(f"--out {options.out}: {error.strerror}") from error
    drives = read_drives(options.out / "report.json") if options.resume else []
    there = {drive.name for drive in drives}
    left = [trial for trial in _trials(options) if "-".join(map(str, trial)) not in there]
    try:
        if left:
            _drive_all(options, left, drives)
    finally:
        if drives:  # what was driven is kept, however it ended
            print(table(summarize(drives)), flush=True)
            _write(drives, options.out, write_chart)
    return PASSED if passed(drives) else NOT_PASSED


def _trials(options: Options) -> Iterator[tuple[str, int, int]]:
    """Set, seed and repeat of each drive."""
    for repeat in range(options.repeats):
        yield from ((YARDS, seed, repeat) for seed in options.yards)
    yield from ((CROSSINGS, seed, 0) for seed in options.crossings)


def _drive_all(options: Options, trials: list[tuple[str, int, int]], drives: list[Drive]) -> None:
    with Family() as family:
        run = RosRun(family, options.out / "log")
        run.start_roscore()
        rig = Rig(run, options.real_time_factor, options.parameters)
        for number, (kind, seed, repeat) in enumerate(trials, start=1):
            if kind == YARDS:
                yard = draw_yard(seed)
                (options.out / "worlds" / f"yard_{seed}.world").write_text(
                    world(yard_model(yard)), encoding="utf-8")
                drive, way = through_yard(rig, yard, repeat)
            else:
                drive, way = past_person(rig, draw_crossing(seed))
            drives.append(drive)
            print(f"[{number}/{len(trials)}] {drive_line(drive)}", flush=True)
            _write_way(options.out, drive, way)
            write_report(drives, options.out / "report.json")


def _write_way(out: Path, drive: Drive, way: Way) -> None:
    rounded = [[round(value, 4) for value in place] for place in way]
    (out / "drives" / f"{drive.name}.json").write_text(json.dumps(rounded) + "\n")


def _write(drives: list[Drive], out: Path, write_chart: Callable) -> None:
    write_chart(drives, out / "trials.png")
    names = ("report.json", "trials.png", *write_sheets(drives, out))
    print(f"written to {out}: {', '.join(names)}", flush=True)
