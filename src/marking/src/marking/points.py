"""From a drive to points, and the words for them in the terminal's language."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from terminal_language import translated
from terminal_language.wanted import wanted_language

from marking.rules import Points

NOT_RUN = "not run"  # the outcome where the course, not the submission, failed


@dataclass(frozen=True)
class Mark:
    """The mark of one case; `outcome` "not run" is the course's fault, not the student's."""

    name: str
    student: str
    case: str
    outcome: str
    points: float
    lost: tuple[str, ...]  # "-5.1: why", the first cause first, "; " between causes
    folder: str  # relative to the results folder; "": nothing was driven
    note: str = ""  # a remark, in one line
    submission_sha256: str = ""  # of the submission's files
    did: str = ""  # what the car did, in few words


def by_student(marks: Sequence[Mark]) -> dict[str, list[Mark]]:
    """Marks by student, sorted by name, whatever order they were marked in."""
    return {student: [mark for mark in marks if mark.student == student]
            for student in sorted({mark.student for mark in marks})}


def mean(points: Sequence[float]) -> float:
    """Mean points of a submission's cases."""
    return round(sum(points) / len(points), 2) if points else 0.0


def points_of(drive: Mapping, points: Points) -> tuple[float, list[str]]:
    """Points of one case, and a line for each loss; `drive` is a case's report.json."""
    if drive["violations"]:
        return 0.0, [_loss(points.most, drive["violations"])]
    share = _driven(drive)
    if drive["fault"]:
        way = did(drive | {"fault": ""}) if share else ""
        return 0.0, [_loss(points.most, [drive.get("exception"), drive["fault"], way])]
    line = _share(drive["rms_lateral_m"], points.line_best_m, points.line_worst_m)
    speed = _share(drive["mean_speed_m_s"], points.speed_best_m_s, points.speed_worst_m_s)
    had = share * (points.finish + line * points.line + speed * points.speed)
    # All points are scaled by how far the car came: what was not driven costs its share of each.
    rows = [(points.most * (1 - share), [drive.get("exception"), drive["why"]]),
            (share * points.line * (1 - line),
             [f"{drive['rms_lateral_m'] * 100:.1f} cm off the line"
              f" ({points.line_best_m * 100:g} cm or less costs nothing)"]),
            (share * points.speed * (1 - speed),
             [f"{drive['mean_speed_m_s']:.3f} m/s on average"
              f" ({points.speed_best_m_s:g} m/s or more costs nothing)"])]
    return round(had, 2), [_loss(lost, why) for lost, why in rows if round(lost, 1) > 0]


def did(drive: Mapping) -> str:
    """What the car did, in few words; `drive` is a case's report.json."""
    if drive["violations"] or drive["outcome"] == NOT_RUN:
        return drive["outcome"]
    if drive["fault"]:
        return "the program failed"
    if _driven(drive) == 1:
        laps = drive["laps_wanted"]
        return "lap finished" if laps == 1 else f"{laps} laps finished"
    if not drive["mean_speed_m_s"]:
        return "the car never moved"
    return f"{_driven(drive):.0%} of the way driven"


def _driven(drive: Mapping) -> float:
    """The driven share of the way, 0 to 1."""
    closed = drive.get("laps_closed", 0) >= drive.get("laps_wanted", 1)
    return 1.0 if closed else drive.get("driven_share", 0.0)


def _share(value: float, best: float, worst: float) -> float:
    """1 at `best` or better, 0 at `worst` or worse, linear between."""
    if best == worst:
        return float(value <= best)
    return min(max((worst - value) / (worst - best), 0.0), 1.0)


def _loss(points: float, causes: Sequence[str | None]) -> str:
    return f"-{figure(points)}: {'; '.join(filter(None, causes))}"


def figure(points: float) -> str:
    """Points as a person reads them."""
    return f"{round(points, 1):g}"


# What joins the words: points, most and what the car did; between sentences, parts and causes.
ENGLISH, CHINESE = ("{} of {}: {}", ". ", ": ", "; "), ("{} 分（满分 {}）：{}", "。", "：", "；")


def is_chinese() -> bool:
    """Whether the locale or LANGUAGE asks for Chinese."""
    return wanted_language(dict(os.environ)) == "zh_CN"


def colon() -> str:
    """What stands between a name and what is said of it, in the wanted language."""
    return (CHINESE if is_chinese() else ENGLISH)[2]


def losses(mark: Mark) -> list[str]:
    """A line for each loss, in the wanted language."""
    _, _, colon, joint = CHINESE if is_chinese() else ENGLISH
    parts = (each.partition(": ") for each in mark.lost)
    return [amount + colon + joint.join(map(translated, why.split("; ")))
            for amount, _, why in parts]


def headline(mark: Mark, most: float) -> str:
    """`94.9 of 100: lap finished`, in the wanted language."""
    form = (CHINESE if is_chinese() else ENGLISH)[0]
    return form.format(figure(mark.points), f"{most:g}", translated(mark.did or mark.outcome))


def sentence(mark: Mark, most: float) -> str:
    """The headline and all losses, in one line."""
    stop = (CHINESE if is_chinese() else ENGLISH)[1]
    return stop.join([headline(mark, most), *losses(mark)])


def case_title(case: str) -> str:
    """`track 0, seed 1` of a case's name, track0-seed1, in the wanted language."""
    track, _, seed = case.removeprefix("track").partition("-seed")
    return translated(f"track {track}, seed {seed}")
