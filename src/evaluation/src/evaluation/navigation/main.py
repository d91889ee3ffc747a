"""The run from beginning to end: map, start again, localise, visit goals, end all, report."""

from __future__ import annotations

import sys
from pathlib import Path

import cv2
import numpy as np

from evaluation.house.ground import Ground
from evaluation.house.progress import Progress
from evaluation.house.watch import Watch
from evaluation.navigation.film import Film
from evaluation.navigation.options import Options, parse_options
from evaluation.navigation.parts import MappingPart, NavigationPart
from evaluation.navigation.picture import map_picture
from evaluation.navigation.report import lines, read_map_frame, write_report
from evaluation.navigation.score import Result
from evaluation.session.failure import RunError
from evaluation.session.launch import Launched
from evaluation.session.processes import Family
from evaluation.session.versions import versions
from evaluation.trial.program import NOT_PASSED, PASSED, run_program
from map_server.errors import MapFileError
from map_server.map_files import read_map

RESULTS = ("map.png", "run.mp4", "report.json")
MAP_FILES = ("map.pgm", "map.yaml")


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("navigate", lambda: _run(parse_options(arguments)))


class NavigationRun:
    """One run: who takes part in it and what was found."""

    def __init__(self, options: Options):
        self.options, self.progress, self.result = options, Progress(), Result()
        self._ground = Ground(options.house)
        self._check_way_points()
        self._goals = self._ground.draw_goals(options.goals, options.seed)
        if options.map:
            try:
                self.result.map = read_map(options.map)[0]
                self.result.map_in_world = read_map_frame(options.map.parent / "report.json")
            except MapFileError as error:
                raise RunError(str(error)) from error
        self._watch: Watch | None = None
        self.film: Film | None = None

    def drive(self, launched: Launched) -> None:
        """Both parts, or the second on a map that is there."""
        self.progress.status("starting roscore")
        launched.start_roscore()
        self._watch = Watch(launched.master_uri)
        self._watch.start()
        if self.options.video:
            self.film = Film(self.options.out / "run.mp4", self._ground, self._watch, self.result)
            self.film.start()
        self.progress.say(f"watch it: export ROS_MASTER_URI={launched.master_uri}")
        everybody = self.options, self._ground, self._watch, launched, self.progress
        map_file = self.options.map
        if map_file is None:
            self._tell("mapping: slam_gmapping, move_base to way-points")
            part = MappingPart(*everybody)
            part.run(self.result)
            part.end()
            map_file = self.options.out / "map.yaml"
        self._tell(f"{len(self._goals)} goals: map_server, amcl, move_base")
        NavigationPart(*everybody).run(self.result, str(map_file), self._goals)

    def stop(self) -> None:
        """Film no more."""
        if self.film is not None:
            self.film.stop()

    def close(self) -> None:
        """Look no more, and finish the film."""
        if self._watch is not None:
            self._watch.stop()
        if self.film is not None:
            self.film.close()

    def report(self, outcome: tuple[str, str], log_folder: Path) -> None:
        """Write map.png and report.json, print the figures and where the files are."""
        out = self.options.out
        log = [line for path in sorted(log_folder.glob("*simulator.log"))
               for line in path.read_text(encoding="utf-8", errors="replace").splitlines()]
        made_with = {"film": (self.film.codec or None) if self.film else None,
                     "versions": versions(Path(__file__).parent, log)}
        picture = map_picture(self._ground, self.result, *_titles(self.options, self.result))
        cv2.imwrite(str(out / "map.png"), picture)
        write_report(out / "report.json", self.options, outcome, self.result, made_with)
        self.progress.say("\n" + "\n".join(lines(self.options, self.result)))
        made = [str(_short(out / name)) for name in (*RESULTS, *MAP_FILES) if (out / name).exists()]
        self.progress.say(f"files: {'  '.join(made)}")

    def _tell(self, title: str) -> None:
        if self.film is not None:
            self.film.tell(title)

    def _check_way_points(self) -> None:
        for point in self.options.house.way_points:
            if not self._ground.has_room(np.array(point)):
                raise RunError(f"way_points: the robot cannot get to {list(point)} without touching"
                               " a wall: change the house file")


def _run(options: Options) -> int:
    run = NavigationRun(options)
    _prepare(options)
    outcome, end = ("", ""), None
    with Family() as family:
        launched = Launched(family, options.out / "log", vehicle="robot")
        try:
            run.drive(launched)
            faults = run.result.faults
            outcome = ("passed", "") if not faults else ("not passed", "; ".join(faults))
        except (KeyboardInterrupt, RunError) as ended_early:
            end, outcome = ended_early, ("ended early", str(ended_early) or "interrupted")
        run.stop()
        family.interrupt(spare=run.film.process_id if run.film else None)
        run.close()
    if run.result.paths:
        run.report(outcome, launched.log_folder)
    if end is not None:
        raise end
    for fault in run.result.faults:
        print(f"navigate: {fault}", file=sys.stderr)
    return NOT_PASSED if run.result.faults else PASSED


def _prepare(options: Options) -> None:
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        mine = RESULTS if options.map else (*RESULTS, *MAP_FILES)
        for name in mine:  # what is there afterwards is of this run
            (options.out / name).unlink(missing_ok=True)
    except OSError as error:
        raise RunError(f"--out {options.out}: {error.strerror}") from error


def _titles(options: Options, result: Result) -> tuple[str, str]:
    """Headline and figures for the picture."""
    reached = sum(way.reached for way in result.navigation.ways) if result.navigation else 0
    figures = []
    if result.mapping:
        agreement = result.mapping.agreement
        figures += [f"mapping ATE {result.mapping.trajectory.ate_rmse * 100:.1f} cm",
                    f"map {agreement.occupied_near_walls:.1%} right, "
                    f"{agreement.walls_found:.1%} found"]
    if result.navigation:
        mean = result.navigation.localisation.mean
        figures += [f"localised to {mean[0] * 100:.1f} cm, {np.degrees(mean[1]):.1f} deg",
                    f"{result.navigation.driven:.1f} m driven"]
    touched = sum(len(part.contacts) for part in (result.mapping, result.navigation) if part)
    figures.append(f"touched {touched}")
    return f"{reached} of {options.goals} goals reached", "   |   ".join(figures)


def _short(path: Path) -> Path:
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path
