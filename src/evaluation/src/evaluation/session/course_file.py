"""Reads the course files in courses/."""

from __future__ import annotations

from run_session.course import Course
from run_session.resources import find_package, load_record


def load_course(name: str) -> Course:
    """Course `name` of courses/, or the file at that path; a RunError names file and key."""
    return load_record(Course, name, find_package("evaluation") / "courses")


def drivers(course: Course) -> list[str]:
    """Names of the files that can drive on it."""
    return sorted(path.name for path in course.follower_files() if course.drives_by
                  in path.read_text(encoding="utf-8", errors="replace"))
