"""`make race-trials`: laps as in `make race`, each with its own start, camera noise and light."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from racecar_description.track.from_numbers import from_seed
from racecar_description.track.model_files import write_course
from racecar_description.track.wishes import Wishes

from evaluation import lap_trial
from evaluation.command_line import Parser
from evaluation.lap import RACE, draw
from evaluation.lap_trial import LapDrive, LapRecord, LapTrial, Outing, Venue
from evaluation.picture import chart, write_tiles
from evaluation.report import grouped, table_of
from evaluation.trial import Case
from run_session.failure import RunError
from run_session.files import find_package


@dataclass(frozen=True, kw_only=True)
class Lap(LapDrive):
    """One lap, complete or not."""

    least_speed = 1.5

    follower: str
    set: str
    track: str
    time: float | None  # s, of a completed lap
    folder: str  # below the folder for results

    @property
    def name(self) -> str:
        """Its case's name."""
        return f"{self.follower} {self.set} {self.seed}"

    @property
    def line(self) -> str:
        """A one-line summary."""
        said = self.disturbance
        start = f"start {said.sideways * 100:+.0f} cm {said.turn * 57.2958:+.0f}°"
        drawn = f"{start}, noise {said.camera_noise:.3f}, light x{said.light:.2f}"
        time = f" in {self.time:.1f} s" if self.closed else ""
        figures = f"{self.mean_speed:.2f} m/s, RMS {self.rms_lateral * 100:.1f} cm"
        return (f"{self.follower} {self.track} seed {self.seed}: {self.outcome}{time}, {figures}"
                f" ({drawn})")


COLUMNS = {"follower": lambda each: each["follower"], "laps on": lambda each: each["set"],
           **lap_trial.COUNTS, **lap_trial.FIGURES,
           "worst seed": lambda each: str(each["worst_seed"])}


def summarize(laps: Sequence[Lap]) -> list[dict]:
    """A summary for each follower and set, in the order in which they were driven.

    `worst_seed`: of a lap that was not completed, else of that with the largest RMS error.
    """
    groups = grouped(laps, lambda lap: (lap.follower, lap.set))
    return [{**lap_trial.summary(group), "follower": follower, "set": name, "worst_seed": max(
        group, key=lambda lap: (not lap.closed, lap.rms_lateral)).seed}
        for (follower, name), group in groups.items()]


COLOURS = ("#1b6ca8", "#c9782f", "#7a8b99", "#3a8f5c")
LIMIT_COLOUR = "#c0392b"
TILE_PX = 440, 320  # of a path

# Label, value, limit, and which side of the limit is good.
ROWS: tuple[tuple[str, Callable[[Lap], float], float, str], ...] = (
    ("RMS beside the line, cm", lambda lap: lap.rms_lateral * 100, Lap.most_rms * 100, "at most"),
    ("mean speed, m/s", lambda lap: lap.mean_speed, Lap.least_speed, "at least"),
)


def write_chart(laps: Sequence[Lap], path: Path) -> None:
    """A column for each set of laps; a cross marks a lap that was not completed."""
    sets = grouped(laps, lambda lap: lap.set)
    with chart(path, len(ROWS), len(sets), sharey="row") as grid:
        for column, (name, found) in enumerate(sets.items()):
            for axes, (label, value, limit, side) in zip(grid[:, column], ROWS, strict=True):
                _draw(axes, found, value)
                axes.axhline(limit, color=LIMIT_COLOUR, linewidth=1, label=f"{side} {limit:g}")
                axes.set_ylabel(label, fontsize=9)
            grid[0, column].set_title(name, fontsize=10)
            grid[-1, column].set_xlabel("seed", fontsize=9)
        for axes in grid[:, 0]:  # the rest of the row shares it
            axes.set_ylim(bottom=0)
        grid[0, 0].legend(fontsize=8)


def _draw(axes: object, laps: Sequence[Lap], value: Callable[[Lap], float]) -> None:
    seeds = sorted({lap.seed for lap in laps})
    followers = list(dict.fromkeys(lap.follower for lap in laps))
    for (follower, closed), found in grouped(laps, lambda lap: (lap.follower, lap.closed)).items():
        axes.plot([seeds.index(lap.seed) for lap in found], [value(lap) for lap in found],
                  "o" if closed else "x", label=f"{follower}{'' if closed else ', not closed'}",
                  color=COLOURS[followers.index(follower) % len(COLOURS)])
    axes.set_xticks(range(len(seeds)), [str(seed) for seed in seeds])
    axes.margins(y=0.1)


def write_path_sheet(laps: Sequence[Lap], out: Path) -> Path:
    """Write OUT/paths_<follower>.png with a tile for each of the follower's laps."""
    path = out / f"paths_{Path(laps[0].follower).stem}.png"
    write_tiles(path, [_tile(out, lap) for lap in laps])
    return path


def _tile(out: Path, lap: Lap) -> tuple[str, bool, np.ndarray]:
    """The lap's path with its caption, and whether it was within the limits."""
    tile = np.zeros((*TILE_PX[::-1], 3), np.uint8)
    picture = cv2.imread(str(out / lap.folder / "path.png"))
    if picture is not None:
        scale = min(TILE_PX[0] / picture.shape[1], TILE_PX[1] / picture.shape[0])
        small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        tile[:small.shape[0], :small.shape[1]] = small
    figures = f"{lap.mean_speed:.2f} m/s, RMS {lap.rms_lateral * 100:.1f} cm"
    return f"{lap.track}, seed {lap.seed}: {lap.outcome}, {figures}", lap.within_limits, tile


RACETRACK, RANDOM_TRACKS = "racetrack", "random tracks"  # the two sets of laps
LARGEST_SEED = 100_000_000  # course_run takes no larger ones
FOLLOWERS = ("lane_follow.py", "lane_follow_p.py")
LONGEST_LAP = 120.0  # s, simulated


class RaceTrial(LapTrial):
    """Laps on the racetrack and on random tracks; the first follower must be within the limits."""

    program = "race_trials"
    does = ("Drive many laps, each with a start, camera noise and light of its own; compare"
            " followers.")
    good = "all laps of the first follower closed within the limits"
    writes = "report.json, report.html, trials.png and the laps"
    result, listed = Lap, "laps"

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "laps on the racetrack")
        parser.add_whole("--first-seed", 0, "seed of the first of them", most=LARGEST_SEED)
        parser.add_whole("--tracks", 10, "random tracks, a lap on each")
        parser.add_whole("--first-track", 101, "seed of the first of them", most=LARGEST_SEED)
        parser.add_argument(
            "--followers", nargs="+", default=FOLLOWERS, metavar="FILE",
            help=f"scripts of car_control; the first must pass ({' '.join(FOLLOWERS)})")

    def check(self, options: argparse.Namespace) -> None:
        if not options.seeds and not options.tracks:
            raise RunError("--seeds 0 --tracks 0: nothing to drive")

    def cases(self, options: argparse.Namespace) -> list[Case]:
        """The followers alternate."""
        followers = tuple(dict.fromkeys(options.followers))
        return [Case(f"{follower} {kind} {seed}", kind, seed, follower)
                for kind, first, count in ((RACETRACK, options.first_seed, options.seeds),
                                           (RANDOM_TRACKS, options.first_track, options.tracks))
                for seed, follower in itertools.product(range(first, first + count), followers)]

    def outing(self, out: Path, case: Case) -> Outing:
        venue = (racetrack() if case.set == RACETRACK else
                 random_track(case.seed, out / "tracks"))
        name = venue.world.stem
        folder = out / "laps" / f"{name}-{case.seed}"
        return Outing(f"{case.driver} on {name}, seed {case.seed}", "race", case.driver, venue,
                      folder, folder / Path(case.driver).stem, draw(case.seed, RACE), LONGEST_LAP)

    def judge(self, record: LapRecord) -> Lap:
        case, outing, report = record.case, record.outing, record.report
        folder = Path(*outing.out.parts[-3:])  # laps/TRACK-SEED/FOLLOWER
        return Lap(**lap_trial.seen(report, case.seed, outing.disturbance), set=case.set,
                   follower=report["follower"], track=outing.venue.world.stem, folder=str(folder),
                   time=report["laps"][0]["time_s"] if report["laps"] else None)

    def passed(self, results: Sequence[Lap]) -> bool:
        first = self.options.followers[0]
        return all(lap.within_limits for lap in results if lap.follower == first)

    def table(self, results: Sequence[Lap]) -> str:
        return table_of(COLUMNS, summarize(results), left=(0, 1))

    def values(self, results: Sequence[Lap]) -> dict:
        return super().values(results, summaries=summarize(results))

    def pictures(self, results: Sequence[Lap], out: Path) -> list[str]:
        write_chart(results, out / "trials.png")
        sheets = [write_path_sheet(laps, out)
                  for laps in grouped(results, lambda lap: lap.follower).values()]
        return ["trials.png", *(sheet.name for sheet in sheets)]


def racetrack() -> Venue:
    """The racetrack of racecar_description."""
    return _venue("racetrack", find_package("racecar_description"))


def random_track(seed: int, out: Path) -> Venue:
    """Generate the seed's track below `out`, as make_track does."""
    course, _ = from_seed(seed, Wishes(f"random_{seed}"))
    write_course(course, out)
    return _venue(course.name, out)


def _venue(name: str, root: Path) -> Venue:
    return Venue(root / "worlds" / f"{name}.world", root / "tracks" / f"{name}.yaml",
                 root / "models")
