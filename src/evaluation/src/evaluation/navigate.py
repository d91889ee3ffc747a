"""`make navigate`: map, restart, localise, visit goals, end all, report."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from evaluation.command_line import LARGEST_SEED, Parser
from evaluation.house import Watch, load_house
from evaluation.live import LiveDrive, Outcome
from evaluation.navigate_parts import Part, map_house, read_map_frame, visit_goals
from evaluation.navigate_pictures import Film, map_picture
from evaluation.navigate_score import Result, lines, mismatch, reached, summarize
from evaluation.picture import write_image
from evaluation.report import cell, write_json
from evaluation.run_page import RUN_PAGE
from map_server.errors import MapFileError
from map_server.map_files import read_map
from run_session.failure import RunError
from run_session.launch import Launched


class NavigationRun(LiveDrive):
    """One run: its parts and results."""

    program = "navigate"
    does = ("Map a house, start again on that map, visit goals in it; all without a screen. Scores"
            " map, localisation and driving, writes a report.")
    ends = ("0 all goals reached, nothing touched, map and localisation within their limits, 1 not"
            " so")
    usual_out = "out/navigate"
    vehicle = "robot"
    logs = "*simulator.log"
    writes = ("map.png", "run.mp4", RUN_PAGE, "report.json", "map.pgm", "map.yaml", "map.json")
    stay = writes[4:]

    @classmethod
    def add_options(cls, parser: Parser) -> None:
        parser.add_whole("--goals", 5, "goals to visit, drawn from the seed", least=1)
        parser.add_whole("--seed", 0, "of noise, goals and the first pose", most=LARGEST_SEED)
        parser.add_pace("simulated seconds a second; below 1 on a slow machine (1)")
        parser.add_argument("--house", default="house", type=load_house, metavar="NAME",
                            help="a house of houses/, or a file (house)")
        parser.add_argument("--map", type=Path, metavar="YAML", help="no mapping round: navigate"
                            " on this map, which was made by a run with the same house")

    @classmethod
    def check(cls, options: argparse.Namespace) -> argparse.Namespace:
        if options.map is not None and not options.map.exists():
            raise RunError(f"--map {options.map}: no such file; it is a map's NAME.yaml")
        options.map = options.map and options.map.resolve()
        return options

    def __init__(self, options: argparse.Namespace):
        super().__init__(options)
        self.result = Result()
        self._ground = options.house.ground()
        for point in options.house.way_points:
            if not self._ground.has_room(np.array(point)):
                raise RunError(f"way_points: the robot cannot get to {list(point)} without touching"
                               " a wall: change the house file")
        self._goals = self._ground.draw_goals(options.goals, options.seed)
        if options.map:
            try:
                self.result.map = read_map(options.map)[0]
                self.result.map_in_world = read_map_frame(options.map)
            except MapFileError as error:
                raise RunError(str(error)) from error
            if fault := mismatch(self._ground, self.result.map, self.result.map_in_world):
                self.progress.say(f"--map {options.map}: {fault}")
        self._watch: Watch | None = None

    def bring_up(self, launched: Launched) -> None:
        """Start the observers; each part starts its own nodes."""
        self._watch = Watch()
        self._watch.start()
        if self.options.video:
            self.film = Film(self.out / "run.mp4", self._ground, self._watch, self.result)
            self.film.start()

    def watch(self, launched: Launched) -> Outcome:
        """Run both parts, or only the second, on an existing map."""
        everybody = self, self._ground, self._watch, launched
        map_file = self.options.map
        if map_file is None:
            self._tell("mapping: slam_gmapping, move_base to way-points")
            part = Part("mapping", *everybody)
            map_house(part, self.result)
            part.end()
            map_file = self.out / "map.yaml"
        self._tell(f"{len(self._goals)} goals: map_server, amcl, move_base")
        visit_goals(Part("goals", *everybody), self.result, str(map_file), self._goals)
        faults = self.result.faults
        return Outcome("not passed" if faults else "passed", "; ".join(faults), faults)

    def end(self) -> None:
        """Stop observing."""
        if self._watch is not None:
            self._watch.stop()

    def figures(self, outcome: Outcome, log: list[str]) -> dict | None:
        return summarize(self.options, outcome, self.result) if self.result.paths else None

    def write(self, report: dict) -> list[str]:
        picture = map_picture(self._ground, self.result, *_titles(self.options, self.result))
        write_image(self.out / "map.png", picture)
        write_json(report, self.out / "report.json")
        return lines(self.result)

    def _tell(self, title: str) -> None:
        if self.film is not None:
            self.film.title = title


def _titles(options: argparse.Namespace, result: Result) -> tuple[str, str]:
    """Title and subtitle (with figures) of the picture."""
    figures = []
    if mapping := result.mapping:
        figures += [f"mapping ATE {mapping['ate_rmse_m'] * 100:.1f} cm",
                    f"map {mapping['occupied_near_walls']:.1%} right, "
                    f"{mapping['walls_found']:.1%} found"]
    if part := result.navigation:
        off = part["mean_off"]
        figures += [f"localised to {cell(off['m'], 100)} cm, {cell(off['deg'])} deg",
                    f"{part['distance_m']:.1f} m driven"]
    figures.append(f"touched {sum(len(part['contacts']) for part in result.parts)}")
    return f"{reached(result)} of {options.goals} goals reached", "   |   ".join(figures)
