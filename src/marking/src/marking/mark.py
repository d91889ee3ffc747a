"""What a case brought, and all cases of a student."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Mark:
    """What one case brought; `outcome` "not run" is the course's fault, not the student's."""

    name: str
    student: str
    case: str
    outcome: str
    points: float
    lost: tuple[str, ...]
    folder: str  # relative to the results'; "": nothing was driven
    note: str = ""  # what else has to be known of it, in one line
    submission_sha256: str = ""  # of what was handed in


def by_student(marks: Sequence[Mark]) -> dict[str, list[Mark]]:
    """In the order of their names, whatever order they were marked in."""
    return {student: [mark for mark in marks if mark.student == student]
            for student in sorted({mark.student for mark in marks})}
