"""Five robots to drive on flat ground, whose way is compared: what steers them is hidden here."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache

from driving_courses.course import load_course
from driving_courses.drives import RacecarDrive
from driving_courses.packages import find_file
from driving_courses.resources import package_folder, resources

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    Sphere,
    Surface,
)
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xml_values import parse_xml
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.world import World

PERIOD = 0.033  # s between updates of a differential drive
AXLE = (0.0, 1.0, 0.0)
LAID = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.pi / 2, 0.0, 0.0))
# Called with the steps to go, m/s and rad/s: goes on with that command.
Driver = Callable[[int, float, float], None]
ROBOTS = ("waffle", "burger", "racecar", "skid", "sprung")
TRACK = {"waffle": 0.287, "burger": 0.16, "skid": 0.32, "sprung": 0.24}  # m


def spawn(world: World, robot: str) -> tuple[Model, Driver]:
    """One of ROBOTS in the middle of a world, and what drives it."""
    if robot == "racecar":
        return _racecar(world)
    if robot in ("waffle", "burger"):
        model = world.spawn(_turtlebot(robot))
        pairs, diameter = [("wheel_left_joint", "wheel_right_joint")], 0.066
    elif robot == "skid":
        model = world.spawn(_skid_steer())
        pairs, diameter = [("left_front", "right_front"), ("left_back", "right_back")], 0.16
    else:
        model = world.spawn(_on_a_sprung_caster())
        pairs, diameter = [("left", "right")], 0.1
    settings = DiffDriveParameters(TRACK[robot], diameter, 1.0, 10.0)
    return model, _differential(world, [
        DiffDrive(model.joint(left), model.joint(right), settings) for left, right in pairs])


def _differential(world: World, drives: Sequence[DiffDrive]) -> Driver:
    period = round(PERIOD / world.timestep)

    def drive(steps: int, speed: float, yaw_rate: float) -> None:
        for each in drives:
            each.command(speed, yaw_rate)
        end = world.tick + steps
        while world.tick < end:
            if world.tick % period == 0:
                for each in drives:
                    each.update(PERIOD)
            world.step(min(end, world.tick // period * period + period) - world.tick)
    return drive


def _racecar(world: World) -> tuple[Model, Driver]:
    course = load_course("race")
    urdf, description = _racecar_files()
    model = world.spawn(description)
    car = RacecarDrive(world, model, urdf, find_file(course.settings))

    def drive(steps: int, speed: float, yaw_rate: float) -> None:
        car.command(speed, math.atan(yaw_rate * course.wheelbase / speed) if speed else 0.0)
        car.run(world.tick + steps)
    return model, drive


@cache
def _racecar_files() -> tuple:
    course = load_course("race")
    text = expand(find_file(course.robot), find_package=package_folder)
    return parse_xml(text, course.robot), load_model(text, resources(course))


@cache
def _turtlebot(name: str) -> ModelDescription:
    course = load_course("line_follow")
    file = find_file(course.robot).parent / f"turtlebot3_{name}.urdf.xacro"
    return load_model(expand(file, find_package=package_folder), resources(course))


def _wheel(name: str, x: float, y: float, radius: float, width: float, mass: float
           ) -> tuple[LinkDescription, JointDescription]:
    across = mass * (3 * radius ** 2 + width ** 2) / 12
    inertial = Inertial(mass, inertia=(across, 0, 0, mass * radius ** 2 / 2, 0, across))
    tyre = Collision("tyre", Cylinder(radius, width), LAID, Surface(mu=1.0, mu2=1.0))
    return (LinkDescription(name, Pose((x, y, radius)), inertial, collisions=(tyre,)),
            JointDescription(name, "continuous", "base", name, axis=AXLE))


def _skid_steer() -> ModelDescription:
    hull = Collision("hull", Box((0.4, 0.25, 0.1)))
    base = LinkDescription("base", Pose((0, 0, 0.08)), Inertial(
        8.0, inertia=(0.1, 0, 0, 0.15, 0, 0.2)), collisions=(hull,))
    wheels = [_wheel(f"{side}_{end}", x, y, 0.08, 0.05, 0.5)
              for side, y in (("left", 0.16), ("right", -0.16))
              for end, x in (("front", 0.13), ("back", -0.13))]
    return ModelDescription("skid", links=(base, *(link for link, _ in wheels)),
                            joints=tuple(joint for _, joint in wheels))


def _on_a_sprung_caster() -> ModelDescription:
    base = LinkDescription("base", Pose((0, 0, 0.05)), Inertial(
        4.0, Pose((-0.03, 0, 0.02)), (0.03, 0, 0, 0.03, 0, 0.05)))
    wheels = [_wheel(name, 0.0, y, 0.05, 0.025, 0.3)
              for name, y in (("left", 0.12), ("right", -0.12))]
    ball = Collision("ball", Sphere(0.02), surface=Surface(mu=0.1, mu2=0.1))
    caster = LinkDescription("caster", Pose((-0.12, 0, 0.02)), Inertial(
        0.1, inertia=(1e-4, 0, 0, 1e-4, 0, 1e-4)), collisions=(ball,))
    spring = JointDescription("spring", "prismatic", "base", "caster", axis=(0.0, 0.0, 1.0),
                              lower=-0.01, upper=0.01, spring_stiffness=2000.0, damping=20.0)
    return ModelDescription("sprung", links=(base, caster, *(link for link, _ in wheels)),
                            joints=(spring, *(joint for _, joint in wheels)))
