"""The trials from beginning to end: try one by one, print, write, end all."""

from __future__ import annotations

from evaluation.course_run.failure import RunError
from evaluation.course_run.launch import Launched
from evaluation.course_run.processes import Family
from evaluation.localisation.options import Options, parse_options
from evaluation.localisation.results import Results, table, trial_line, write_report
from evaluation.localisation.rig import Rig
from evaluation.localisation.trials import find, kidnap, measure_load, track
from evaluation.navigation.ground import Ground
from evaluation.navigation.progress import Progress
from evaluation.program import NOT_PASSED, PASSED, run_program
from map_server.errors import MapFileError
from map_server.map_files import write_map


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("localisation_trials", lambda: _run(parse_options(arguments)))


def _run(options: Options) -> int:
    ground, progress, results = Ground(options.house), Progress(), Results()
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        _, map_file = write_map(options.out / "map", ground.walls)
    except (OSError, MapFileError) as error:
        raise RunError(f"--out {options.out}: {getattr(error, 'strerror', error)}") from error
    watch = None
    try:
        with Family() as family:
            launched = Launched(family, options.out / "log", vehicle="robot")
            rig = Rig(options, ground, launched, str(map_file), progress)
            watch = rig.watch
            _try_all(options, ground, rig, progress, results)
            family.interrupt()
    finally:
        if watch is not None:
            watch.stop()
        if results.trials or results.tracking or results.load:  # kept, however it ended
            progress.say(table(results))
            write_report(results, options.out / "report.json")
            progress.say(f"written to {options.out}: report.json, map.yaml")
    return PASSED if results.passed else NOT_PASSED


def _try_all(options: Options, ground: Ground, rig: Rig, progress: Progress,
             results: Results) -> None:
    for kind in (find, kidnap):
        numbers = options.starts if kind is find else options.kidnaps
        for number in numbers:
            trial = kind(rig, ground, options.seed, number)
            results.trials.append(trial)
            progress.say(f"[{number}/{numbers[-1]}] {trial_line(trial)}")
    rig.use_odometry(options.wheel_odometry)
    if options.tracking:
        results.tracking = track(rig, ground, options.seed, options.tracking)
    if options.load:
        results.load = measure_load(rig, ground, options.seed, options.load)
