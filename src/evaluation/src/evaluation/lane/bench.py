"""All methods on the same seeds: laps, RMS, speed, ms a frame; as a table and a chart."""

from __future__ import annotations

from pathlib import Path

from evaluation.lane.drive import Drive
from evaluation.lane.options import BenchOptions, parse_bench
from evaluation.lane.results import LaneDrive, lap_table, line_of, read_drives, write_report
from evaluation.lane.timing import ms_a_frame
from evaluation.lane.trials import driven
from evaluation.program import PASSED, chart_writer, run_program


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("bench_lanes", lambda: _run(parse_bench(arguments)))


def _run(options: BenchOptions) -> int:
    write_chart = chart_writer("evaluation.lane.chart")  # what is missing is said at once
    options.out.mkdir(parents=True, exist_ok=True)
    path = options.out / "report.json"
    times = {method: round(ms_a_frame(method), 2) for method in options.methods}
    drives = read_drives(path) if options.resume else []
    try:
        _drive_all(options, drives, path)
    finally:
        if drives:
            write_report(drives, path, ms_a_frame=times)
            write_chart(drives, times, options.out / "lanes.png")
            print(lap_table(drives, times), flush=True)
            for drive in drives:
                if not drive.closed:
                    print(f"{drive.method}, seed {drive.seed}: {drive.why}", flush=True)
            print(f"written to {options.out}: report.json, lanes.png", flush=True)
    return PASSED  # a method that fails is a finding here


def _drive_all(options: BenchOptions, drives: list[LaneDrive], path: Path) -> None:
    there = {(each.method, each.seed) for each in drives}
    for seed in options.seeds:
        for method in options.methods:
            if (method, seed) not in there:
                what = Drive(method, seed, 1, people=False)
                drives.append(driven(what, options.out / "drives"))
                print(line_of(drives[-1]), flush=True)
                write_report(drives, path)
