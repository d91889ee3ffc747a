"""`make bench-lanes`: all methods on the same seeds: laps, RMS, speed, ms a frame."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

from lane_keeping.world.timing import ms_a_frame

from evaluation.lane.outcomes import LaneDrive, lap_table
from evaluation.lane.trial import LaneCase, LaneDrives, known_methods, lane_case
from evaluation.picture import chart
from evaluation.trial.command_line import Parser, one_of
from evaluation.trial.report import grouped
from run_session.failure import RunError

COLOUR, FAILED, LIMIT = "#1b6ca8", "#c0392b", "#7a8b99"


class LaneComparison(LaneDrives):
    """Compares methods; a method that fails is a result, not a failure of the program."""

    program = "bench_lanes"
    does = "Compare all methods on the same seeds."
    good = "all were driven"
    writes = "report.json, report.html, lanes.png and the drives"

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 5, "laps of each method")
        parser.add_argument("--methods", nargs="+", metavar="NAME", help="some of them (all)")

    def check(self, options: argparse.Namespace) -> None:
        options.methods = tuple(dict.fromkeys(options.methods or known_methods()))
        for method in options.methods:
            one_of("method", "METHOD", known_methods(), method)
        if not options.seeds:
            raise RunError("--seeds 0: nothing to drive")
        self._methods, self._times = options.methods, {}

    def cases(self, options: argparse.Namespace) -> list[LaneCase]:
        return [lane_case(method, seed)
                for seed in range(options.seeds) for method in options.methods]

    def passed(self, results: Sequence[LaneDrive]) -> bool:
        return True

    def table(self, results: Sequence[LaneDrive]) -> str:
        failed = [f"{each.method}, seed {each.seed}: {each.why}"
                  for each in results if not each.closed]
        return "\n".join([lap_table(results, self._ms_a_frame()), *failed])

    def values(self, results: Sequence[LaneDrive]) -> dict:
        return super().values(results, ms_a_frame=self._ms_a_frame())

    def pictures(self, results: Sequence[LaneDrive], out: Path) -> list[str]:
        write_chart(results, self._ms_a_frame(), out / "lanes.png")
        return ["lanes.png"]

    def _ms_a_frame(self) -> dict[str, float]:
        """CPU time per image of each method, ms; measured once."""
        for method in self._methods:
            if method not in self._times:
                self._times[method] = round(ms_a_frame(method), 2)
        return self._times


def write_chart(drives: Sequence[LaneDrive], times: Mapping[str, float], path: Path) -> None:
    """Three panels, a row for each method; a red cross marks a lap that was not completed."""
    methods = grouped(drives, lambda drive: drive.method)
    with chart(path, 1, 3, sharey=True) as ((rms, speed, time),):
        for number, (method, found) in enumerate(methods.items()):
            for drive in found:
                marker, colour = ("o", COLOUR) if drive.closed else ("x", FAILED)
                rms.plot(drive.rms_lateral * 100, number, marker, color=colour)
                speed.plot(drive.mean_speed, number, marker, color=colour)
            time.barh(number, times.get(method, 0.0), height=0.5, color=COLOUR)
        rms.axvline(LaneDrive.most_rms * 100, color=LIMIT, linewidth=1)
        speed.axvline(LaneDrive.least_speed, color=LIMIT, linewidth=1)
        for axes, title in ((rms, "RMS from the lane's middle, cm"), (speed, "mean speed, m/s"),
                            (time, "processor time, ms a picture")):
            axes.set_xlim(0, 1.05 * axes.get_xlim()[1])
            axes.set_title(title, fontsize=10)
        rms.set_yticks(range(len(methods)), methods)
        rms.invert_yaxis()
        rms.set_xlabel("o lap closed   x not closed   grey: limit", fontsize=9)
