"""The run from beginning to end: map, start again, localise, visit goals, end all, report."""

from __future__ import annotations

from collections.abc import Sequence
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
from evaluation.session.versions import versions
from evaluation.trial.live import LiveDrive, Outcome, run_live
from evaluation.trial.program import run_program
from map_server.errors import MapFileError
from map_server.map_files import read_map

RESULTS = ("map.png", "run.mp4", "report.json")
MAP_FILES = ("map.pgm", "map.yaml")


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("navigate", lambda: run_live(NavigationRun(parse_options(arguments))))


class NavigationRun(LiveDrive):
    """One run: who takes part in it and what was found."""

    program = "navigate"
    vehicle = "robot"
    writes = (*RESULTS, *MAP_FILES)

    def __init__(self, options: Options):
        super().__init__(options.out, Progress())
        self.options, self.result = options, Result()
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

    def bring_up(self, launched: Launched) -> None:
        """The master, and who looks on; each part brings up its own nodes."""
        self.progress.status("starting roscore")
        launched.start_roscore()
        self._watch = Watch(launched.master_uri)
        self._watch.start()
        if self.options.video:
            self.film = Film(self.options.out / "run.mp4", self._ground, self._watch, self.result)
            self.film.start()
        self.progress.say(f"watch it: export ROS_MASTER_URI={launched.master_uri}")

    def watch(self, launched: Launched) -> Outcome:
        """Both parts, or the second on a map that is there."""
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
        faults = self.result.faults
        return ("not passed", "; ".join(faults)) if faults else ("passed", "")

    def end(self) -> None:
        """Look no more."""
        if self._watch is not None:
            self._watch.stop()

    @property
    def was_seen(self) -> bool:
        return bool(self.result.paths)

    def faults(self, outcome: Outcome) -> list[str]:
        return self.result.faults

    def owned_files(self) -> Sequence[str]:
        return RESULTS if self.options.map else self.writes

    def report(self, outcome: Outcome, log_folder: Path) -> None:
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
        self.name_files()

    def _tell(self, title: str) -> None:
        if self.film is not None:
            self.film.tell(title)

    def _check_way_points(self) -> None:
        for point in self.options.house.way_points:
            if not self._ground.has_room(np.array(point)):
                raise RunError(f"way_points: the robot cannot get to {list(point)} without touching"
                               " a wall: change the house file")


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
