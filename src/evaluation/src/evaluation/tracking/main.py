"""`make track` from beginning to end: bring up, watch, end everything, report."""

from __future__ import annotations

from pathlib import Path

import cv2

from evaluation.session.failure import RunError
from evaluation.session.launch import Launched
from evaluation.session.processes import Family, strip_terminal_codes
from evaluation.session.status_line import StatusLine
from evaluation.tracking.options import Options, parse_options
from evaluation.tracking.report import lines, path_picture, summarize, write_report
from evaluation.tracking.run import TrackRun
from evaluation.trial.program import NOT_PASSED, PASSED, run_program

RESULTS = ("path.png", "run.mp4", "report.json")


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("track", lambda: _run(parse_options(arguments)))


def _run(options: Options) -> int:
    options.out.mkdir(parents=True, exist_ok=True)
    for name in RESULTS:  # what is there afterwards is of this run
        (options.out / name).unlink(missing_ok=True)
    progress, end = StatusLine(), None
    run = TrackRun(options, progress)
    with Family() as family:
        launched = Launched(family, options.out / "log", options.tracker)
        try:
            run.bring_up(launched)
            run.watch(launched)
        except (KeyboardInterrupt, RunError) as ended_early:
            end = ended_early
        run.end()
        family.interrupt(spare=run.film.process_id)  # they end while the film is being finished
        run.film.close()
    if run.drive.samples:
        _report(run, progress, launched.log_folder / "roslaunch.log")
    if end is not None:
        raise end
    return PASSED if run.drive.good else NOT_PASSED


def _report(run: TrackRun, progress: StatusLine, log: Path) -> None:
    out = run.options.out
    said = strip_terminal_codes(log.read_text(encoding="utf-8", errors="replace")).splitlines()
    report = summarize(run, said)
    write_report(report, out)
    cv2.imwrite(str(out / "path.png"), path_picture(run, report))
    progress.say("\n" + "\n".join(lines(report)))
    here = Path.cwd()
    made = [out / name for name in RESULTS if (out / name).exists()]
    shown = [str(path.relative_to(here) if path.is_relative_to(here) else path) for path in made]
    progress.say(f"files: {'  '.join(shown)}")
