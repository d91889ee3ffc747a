"""The marks of a case, and of all cases of a student."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Mark:
    """The mark of one case; `outcome` "not run" is the course's fault, not the student's."""

    name: str
    student: str
    case: str
    outcome: str
    points: float
    lost: tuple[str, ...]
    folder: str  # relative to the results folder; "": nothing was driven
    note: str = ""  # a remark, in one line
    submission_sha256: str = ""  # of the submission's files


def by_student(marks: Sequence[Mark]) -> dict[str, list[Mark]]:
    """Marks by student, sorted by name, whatever order they were marked in."""
    return {student: [mark for mark in marks if mark.student == student]
            for student in sorted({mark.student for mark in marks})}
