"""The simulator's search paths for a course; the environment's variables do not count."""

from __future__ import annotations

from pathlib import Path

from bullet_sim.formats.resources import Resources
from driving_courses.course import CourseSpec
from driving_courses.packages import find_file, find_package


def package_folder(name: str) -> str:
    """For files that say package://NAME or $(find NAME)."""
    return str(find_package(name))


def resources(course: CourseSpec, models: tuple[Path, ...] = ()) -> Resources:
    """`models`: folders in which models are found first."""
    library = Resources.from_environment({"HOME": "/nonexistent"})
    return Resources(
        [*models, *map(find_file, course.model_paths), *library.model_paths],
        [*library.resource_paths, *map(find_file, course.resource_paths)], package_folder)
