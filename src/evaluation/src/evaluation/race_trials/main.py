"""The trials from beginning to end: drive lap by lap, print, write, draw."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from pathlib import Path

from evaluation.course_run.failure import RunError
from evaluation.program import NOT_PASSED, PASSED, chart_writer, run_program
from evaluation.race_trials.disturbance import draw
from evaluation.race_trials.drive import drive
from evaluation.race_trials.options import Options, parse_options
from evaluation.race_trials.path_sheet import write_path_sheet
from evaluation.race_trials.results import (
    Lap,
    lap_line,
    read_laps,
    summarize,
    table,
    write_report,
)
from evaluation.race_trials.venue import RACETRACK, RANDOM_TRACKS, racetrack, random_track


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("race_trials", lambda: _run(parse_options(arguments)))


def _run(options: Options) -> int:
    write_chart = chart_writer("evaluation.race_trials.chart")  # what is missing is said at once
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunError(f"--out {options.out}: {error.strerror}") from error
    laps = read_laps(options.out / "report.json") if options.resume else []
    try:
        _drive_all(options, laps)
    finally:
        if laps:  # what was driven is kept, however it ended
            print(table(summarize(laps)), flush=True)
            _write(laps, options.out, write_chart)
    first = [lap for lap in laps if lap.follower == options.followers[0]]
    return PASSED if all(lap.within_limits for lap in first) else NOT_PASSED


def _drive_all(options: Options, laps: list[Lap]) -> None:
    wanted = len(options.followers) * (len(options.seeds) + len(options.tracks))
    there = {(lap.follower, lap.set, lap.seed) for lap in laps}
    for number, (kind, seed, follower) in enumerate(_trials(options), start=1):
        if (follower, kind, seed) in there:
            continue
        venue = racetrack() if kind == RACETRACK else random_track(seed, options.out / "tracks")
        laps.append(drive(venue, seed, draw(seed), follower, options.out / "laps"))
        print(f"[{number}/{wanted}] {lap_line(laps[-1])}", flush=True)
        write_report(laps, options.out / "report.json")


def _trials(options: Options) -> Iterator[tuple[str, int, str]]:
    """Set, seed and follower of each lap; followers take turns."""
    for kind, seeds in ((RACETRACK, options.seeds), (RANDOM_TRACKS, options.tracks)):
        yield from itertools.product([kind], seeds, options.followers)


def _write(laps: list[Lap], out: Path, write_chart: Callable) -> None:
    write_chart(laps, out / "trials.png")
    sheets = [
        write_path_sheet([lap for lap in laps if lap.follower == follower], out)
        for follower in dict.fromkeys(lap.follower for lap in laps)
    ]
    names = ("report.json", "trials.png", *(sheet.name for sheet in sheets))
    print(f"written to {out}: {', '.join(names)}", flush=True)
