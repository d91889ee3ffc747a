"""`make lane-trials`, laps in varied light and past people; `make bench-lanes`, all methods."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from lane_keeping.world.scenery import load_crossings
from lane_keeping.world.timing import ms_a_frame
from node_basics.settings import SettingsError
from racecar_description.track.track_file import load_track_file

from evaluation import lane_encounters, lap_trial
from evaluation.command_line import Parser, one_of
from evaluation.lane_encounters import Encounter
from evaluation.lap import Bounds, Disturbance, draw
from evaluation.lap_trial import LapDrive, LapRecord, LapTrial, Outing, Venue
from evaluation.picture import chart
from evaluation.report import cell, grouped, table, table_of
from evaluation.trial import Case
from run_session.course_file import drivers, load_course
from run_session.failure import RunError
from run_session.files import find_package


@dataclass(frozen=True, kw_only=True)
class LaneDrive(LapDrive):
    """One drive."""

    least_speed = 0.6

    method: str
    people: bool
    laps_wanted: int
    laps_closed: int
    nearest_person: float | None = None  # over the whole drive; None: no people
    encounters: tuple[Encounter, ...] = field(default=())

    @property
    def name(self) -> str:
        """Its case's name."""
        return f"{self.method} {PEOPLE if self.people else LAPS}-{self.seed}"

    @property
    def line(self) -> str:
        """A one-line summary, and another line for each encounter that was not passed."""
        failed = [each for each in self.encounters if not each.passed]
        count = len(self.encounters)
        met = f", {count - len(failed)} of {count} encounters passed" if self.people else ""
        drove = (f"{self.method} seed {self.seed}: {self.outcome}, "
                 f"{self.laps_closed} of {self.laps_wanted} laps, {self.mean_speed:.2f} m/s, "
                 f"RMS {self.rms_lateral * 100:.1f} cm{met} (light x{self.disturbance.light:.2f})")
        return "\n  not passed: ".join([drove, *map(str, failed)])

    @property
    def kept_clear(self) -> bool:
        """Whether nobody was touched in the whole drive; False if the distance is unknown."""
        return self.nearest_person is not None and self.nearest_person >= lane_encounters.TOUCHED


def from_report(report: dict, method: str, seed: int, disturbance: Disturbance,
                people: bool) -> LaneDrive:
    """A drive from course_run's report.json."""
    return LaneDrive(**lap_trial.seen(report, seed, disturbance), method=method, people=people,
                     laps_wanted=report["laps_wanted"], laps_closed=report["laps_closed"])


def lap_table(drives: Sequence[LaneDrive], ms_a_frame: dict[str, float] | None = None) -> str:
    """A row for each method; figures are of closed laps."""
    counts = lap_trial.COUNTS
    columns = {"method": lambda found: found["method"], "laps closed": counts["closed"],
               "within limits": counts["within limits"], **lap_trial.FIGURES}
    if ms_a_frame:
        columns["ms a frame"] = lambda found: cell(ms_a_frame.get(found["method"]))
    methods = grouped(drives, lambda drive: drive.method)
    return table_of(columns, [{"method": method, **lap_trial.summary(found)}
                              for method, found in methods.items()])


def encounter_table(drives: Sequence[LaneDrive]) -> str:
    """How often the car kept each rule about people."""
    met = [each for drive in drives for each in drive.encounters]
    if not met:
        return "nobody was met"
    nearest = min(drive.nearest_person for drive in drives if drive.nearest_person is not None)
    stops = [each.stopped_before for each in met if each.stopped_before is not None]
    starts = [each.moved_after for each in met if each.moved_after is not None]
    stood = f"{min(stops):.2f} m before" if stops else "nowhere"

    def kept(rule: str) -> str:
        return f"{sum(getattr(each, rule) for each in met)} of {len(met)}"

    touched = sum(each.touched for each in met)
    rows = [
        ["demanded", "kept", "worst"],
        ["no contact", f"{len(met) - touched} of {len(met)}", f"{nearest:.2f} m, over all drives"],
        [f"{lane_encounters.KEPT_OFF:g} m from person and zebra", kept("stood_off"),
         f"{min(each.nearest for each in met):.2f} m; stood {stood}"],
        [f"moves on within {lane_encounters.MOVES_ON:g} s", kept("moved_on"),
         f"{max(starts):.2f} s" if starts else "-"],
        ["all of it", kept("passed"), ""],
    ]
    return table(rows)


LAPS, PEOPLE = "laps", "people"  # the two sets of drives
LAPS_WITH_PEOPLE = 4  # in a row; starting a simulator takes as long as a quarter of a lap
PEOPLE_FROM = 500  # first seed of the drives with people
BOUNDS = Bounds(sideways=0.05, along=0.0, turn=0.1, camera_noise=(0.0, 0.02), light=(0.6, 1.4))
NEAR = 3.0  # m: people set off once the car is this close, so that they meet
LONGEST_LAP = 240.0  # s, simulated


def lane_case(method: str, seed: int, kind: str = LAPS) -> Case:
    """The case of one lap without people, or of several with people."""
    return Case(f"{method} {kind}-{seed}", kind, seed, method)


class LaneDrives(LapTrial):
    """Shared by the trials of one method and the comparison of all."""

    result, begins_anew = LaneDrive, True

    def outing(self, out: Path, case: Case) -> Outing:
        """With people, poses.txt is written beside the report."""
        lit = out / "drives" / case.name.partition(" ")[2]
        folder = lit / case.driver
        people = case.set == PEOPLE
        package, course = find_package("lane_keeping"), "lane" if people else "lane_empty"
        venue = Venue(package / "worlds" / f"{course}.world", load_course(course).track_path(),
                      package / "models")
        options, record = (), ()
        if people:
            options = ("--launch", "evaluation", "lane.launch")
            record = (f"near:={NEAR:g}", f"record:={folder / 'poses.txt'}")
        return Outing(f"{case.driver}, seed {case.seed}", course, f"{case.driver}.py", venue, lit,
                      folder, draw(case.seed, BOUNDS), LONGEST_LAP,
                      LAPS_WITH_PEOPLE if people else 1, options, record)

    def judge(self, record: LapRecord) -> LaneDrive:
        case, outing = record.case, record.outing
        people = case.set == PEOPLE
        found = from_report(record.report, case.driver, case.seed, outing.disturbance, people)
        if not people:
            return found
        recording = lane_encounters.read_recording(outing.out / "poses.txt")
        lane_half = load_track_file(outing.venue.track).lane_width
        try:
            met = lane_encounters.judge(recording, load_crossings(), lane_half)
        except SettingsError as error:
            raise RunError(str(error)) from error
        nearest = lane_encounters.nearest_ever(recording)
        return replace(found, nearest_person=round(nearest, 3), encounters=tuple(met))


class LaneTrial(LaneDrives):
    """One method's laps without people, and drives with people until enough were met."""

    program = "lane_trials"
    does = "Drive laps in differing light and past people."
    good = "all within the limits"
    writes = "report.json, report.html and the drives"
    open_ended, shared = True, ("method",)

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "laps without people")
        parser.add_whole("--crossings", 100, "people to meet")
        parser.add_argument("--method", default="sliding_windows", metavar="NAME",
                            help="(sliding_windows)")

    def check(self, options: argparse.Namespace) -> None:
        one_of("method", "METHOD", known_methods(), options.method)
        if not options.seeds and not options.crossings:
            raise RunError("--seeds 0 --crossings 0: nothing to drive")

    def cases(self, options: argparse.Namespace) -> list[Case]:
        """Includes at most as many drives with people as encounters are wanted."""
        return [*(lane_case(options.method, seed) for seed in range(options.seeds)),
                *(lane_case(options.method, PEOPLE_FROM + number, PEOPLE)
                  for number in range(options.crossings))]

    def is_needed(self, case: Case, results: Sequence[LaneDrive]) -> bool:
        return case.set == LAPS or count_met(results) < self.options.crossings

    def passed(self, results: Sequence[LaneDrive]) -> bool:
        if count_met(results) < self.options.crossings:
            raise RunError(f"fewer than {self.options.crossings} people were met in as many drives")
        with_people = [each for each in results if each.people]
        return (all(each.within_limits for each in results if not each.people)
                and all(each.closed and each.kept_clear for each in with_people)
                and all(met.passed for each in with_people for met in each.encounters))

    def table(self, results: Sequence[LaneDrive]) -> str:
        laps = [each for each in results if not each.people]
        people = [each for each in results if each.people]
        parts = [lap_table(laps)] if laps else []
        if people:
            closed = sum(each.closed for each in people)
            parts += [f"{closed} of {len(people)} drives with people closed",
                      encounter_table(people)]
        return "\n".join(parts)


def count_met(results: Sequence[LaneDrive]) -> int:
    """People met in all drives."""
    return sum(len(each.encounters) for each in results)


def known_methods() -> list[str]:
    """Names of all methods; sliding_windows comes first."""
    names = [Path(file).stem for file in drivers(load_course("lane"))]
    return sorted(names, key=lambda name: name != "sliding_windows")


COLOUR, FAILED, LIMIT = "#1b6ca8", "#c0392b", "#7a8b99"


@cache
def _measured(method: str) -> float:
    return round(ms_a_frame(method), 2)


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

    def cases(self, options: argparse.Namespace) -> list[Case]:
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
        """CPU time per image of each method, ms."""
        return {method: _measured(method) for method in self.options.methods}


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
