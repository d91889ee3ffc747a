"""Where the packages lie whose worlds, robots and tracks are driven: no ROS is asked."""

from __future__ import annotations

from pathlib import Path

from driving_courses.errors import CourseError

HERE = Path(__file__).resolve().parent
# Name -> folder below src/ of a checkout. setup.py puts copies into the wheel.
FOLDERS = {
    "ai_robot_tracking": "lessons/ai_robot_tracking",
    "car_control": "car_control",
    "evaluation": "evaluation",
    "lane_keeping": "lessons/lane_keeping",
    "learning_topic": "learning_topic",
    "racecar_description": "racecar_description",
    "turtlebot3_description": "compat/turtlebot3_description",
}


def find_package(name: str) -> Path:
    """The folder of one of FOLDERS: of this wheel, this checkout or this install space.

    CourseError lists the folders that were searched.
    """
    if name not in FOLDERS:
        raise CourseError(f"no package {name!r}; there are: {', '.join(FOLDERS)}")
    places = [HERE / "packages" / name, HERE.parents[2] / FOLDERS[name],
              HERE.parents[2] / "share" / name]
    for place in places:
        if (place / "package.xml").exists():
            return place
    raise CourseError(f"package {name!r} is in none of: {', '.join(map(str, places))}")


def find_file(path: str) -> Path:
    """The file or folder behind PACKAGE/REST; CourseError where there is none."""
    package, _, rest = path.removeprefix("package://").partition("/")
    found = find_package(package) / rest
    if not found.exists():
        raise CourseError(f"{found}: no such file")
    return found
