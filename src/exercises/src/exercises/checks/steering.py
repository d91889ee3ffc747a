"""A controllers' YAML file: the racecar's steering hinges, in the simulator's core."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import yaml
from driving_courses.course import load_course
from driving_courses.drives import RacecarDrive
from driving_courses.packages import find_file
from driving_courses.resources import package_folder, resources

from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xml_values import parse_xml
from bullet_sim.pose import Pose
from bullet_sim.world import World
from exercises.errors import CannotCheck, Mistake
from exercises.finding import Finding, near

JOINTS = "left_steering_joint", "right_steering_joint"
MOST_GAIN = 1e9  # of P, I and D


def read(file: Path) -> None:
    """CannotCheck if it is not YAML; Mistake if a required setting is missing or wrong."""
    try:
        table = yaml.safe_load(file.read_text(encoding="utf-8"))
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise CannotCheck(f"{file}: not valid YAML: {' '.join(str(error).split())[:200]}") \
            from error
    if not isinstance(table, dict) or not isinstance(table.get("racecar"), dict):
        raise Mistake(f"{file}: its first key must be `racecar`, with controllers below it")
    for name, entry in table["racecar"].items():
        if wrong := _wrong_in(entry):
            raise Mistake(f"{file}: {name}: {wrong}")


def _wrong_in(entry: object) -> str | None:
    """A controller's missing setting, or one of a wrong type, in words; None: all are right."""
    if not isinstance(entry, dict) or not isinstance(entry.get("type"), str):
        return "lacks `type`"
    if "JointStateController" in entry["type"] and "pid" not in entry:  # it moves nothing
        return None
    if not isinstance(entry.get("joint"), str):
        return "lacks `joint`"
    gains = entry.get("pid")
    if not isinstance(gains, dict):
        return "lacks `pid`"
    for key in ("p", "i", "d"):
        if type(gains.get(key)) not in (int, float) or not abs(gains[key]) < MOST_GAIN:
            return f"`{key}` of its `pid` must be a number"
    return None


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """Both hinges must turn to the commanded angles, on a standing car."""
    read(file)
    course = load_course("race")
    text = expand(find_file(course.robot), find_package=package_folder)
    world = World(load_world(find_file(course.world), resources(course)))
    try:
        car = world.spawn(load_model(text, resources(course)),
                          Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), course.model)
        try:
            drive = RacecarDrive(world, car, parse_xml(text, course.robot), file)
            drive.command(0.0, limits["angle"])
            drive.run(world.tick + round(limits["seconds"] / world.timestep))
        except KeyError as error:
            raise Mistake(f"{file}: {error} is not a controller of this car, or missing in a pid") \
                from error
        except SimulationError as error:
            raise Mistake(f"{file}: {error}") from error
        for joint in JOINTS:
            yield near(f"{joint} after {limits['seconds']:g} s", car.joint(joint).position,
                       limits["angle"], limits["tolerance"], " rad")
    finally:
        world.close()
