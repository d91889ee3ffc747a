"""The drives' results: laps and encounters, one by one and as tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from evaluation.lane.encounters import KEPT_OFF, MOVES_ON, TOUCHED, Encounter
from evaluation.laps.disturbance import Disturbance
from evaluation.laps.lap_trial import COUNTS, FIGURES, LapDrive, seen, summary
from evaluation.trial.report import cell, grouped, table, table_of


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
        return f"{self.method} {'people' if self.people else 'laps'}-{self.seed}"

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
        return self.nearest_person is not None and self.nearest_person >= TOUCHED


def from_report(report: dict, method: str, seed: int, disturbance: Disturbance,
                people: bool) -> LaneDrive:
    """A drive from course_run's report.json."""
    return LaneDrive(**seen(report, seed, disturbance), method=method, people=people,
                     laps_wanted=report["laps_wanted"], laps_closed=report["laps_closed"])


def lap_table(drives: Sequence[LaneDrive], ms_a_frame: dict[str, float] | None = None) -> str:
    """A row for each method; figures are of closed laps."""
    columns = {"method": lambda found: found["method"], "laps closed": COUNTS["closed"],
               "within limits": COUNTS["within limits"], **FIGURES}
    if ms_a_frame:
        columns["ms a frame"] = lambda found: cell(ms_a_frame.get(found["method"]))
    methods = grouped(drives, lambda drive: drive.method)
    return table_of(columns, [{"method": method, **summary(found)}
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
        [f"{KEPT_OFF:g} m from person and zebra", kept("stood_off"),
         f"{min(each.nearest for each in met):.2f} m; stood {stood}"],
        [f"moves on within {MOVES_ON:g} s", kept("moved_on"),
         f"{max(starts):.2f} s" if starts else "-"],
        ["all of it", kept("passed"), ""],
    ]
    return table(rows)
