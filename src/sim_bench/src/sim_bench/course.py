"""The course of learning_topic with its waffle, in the core alone: the scene that is measured."""

from __future__ import annotations

from dataclasses import replace

from driving_courses.course import load_course
from driving_courses.packages import find_file
from driving_courses.resources import package_folder, resources
from racecar_description.track.closed_line import load_track

from bullet_sim.description import SensorDescription
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.xacro.files import expand
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.world import World

COURSE = load_course("line_follow")
SETTLING_STEPS = 300
# The tags of the waffle's drive plugin: what a learner's waffle is driven with.
WAFFLE_DRIVE = DiffDriveParameters(0.287, 0.066, 1.0, 10.0)


class CourseWorld:
    """The world of 0course.launch. Close it: the engine holds a fixed number of worlds."""

    def __init__(self, timestep: float | None = None) -> None:
        """`timestep`: of the engine, s; None: as the world says."""
        found = resources(COURSE)
        world = load_world(find_file(COURSE.world), found)
        if timestep is not None:
            world = replace(world, physics=replace(world.physics, max_step_size=timestep))
        self.world = World(world)
        self.track = load_track(COURSE.track_file)
        self._waffle = load_model(waffle_text(), found)

    def spawn_waffle(self, name: str = COURSE.model, pose: Pose = Pose()) -> Model:
        """A waffle, standing still on its wheels."""
        model = self.world.spawn(self._waffle, pose, name)
        self.world.step(SETTLING_STEPS)
        return model

    def put_on_line(self, waffle: Model, share: float) -> None:
        """Stand the waffle on the yellow line, this share (0..1) of a lap from the start."""
        x, y, heading = self.track.pose(share * self.track.length)
        height = waffle.pose.position[2]
        waffle.set_pose(Pose.from_xyz_rpy((x, y, height), (0.0, 0.0, heading)))

    def view(self, waffle: Model, width: int, height: int) -> CameraView:
        """What the waffle's camera sees now, with another number of pixels."""
        link, sensor = sensor_with(waffle, "cameras")
        camera = sensor.cameras[0]
        pose = link.pose * sensor.pose
        return CameraView(width, height, camera.horizontal_fov, camera.near, camera.far, pose)

    def close(self) -> None:
        """Let go of the engine."""
        self.world.close()


def waffle_text() -> str:
    """The waffle's URDF."""
    return expand(find_file(COURSE.robot), find_package=package_folder)


def drive_of(waffle: Model, speed: float, yaw_rate: float) -> DiffDrive:
    """The waffle's two driven wheels, as its drive plugin has them, commanded m/s and rad/s."""
    drive = DiffDrive(
        waffle.joint("wheel_left_joint"), waffle.joint("wheel_right_joint"), WAFFLE_DRIVE)
    drive.command(speed, yaw_rate)
    return drive


def sensor_with(model: Model, what: str) -> tuple[Link, SensorDescription]:
    """The model's first sensor that has `cameras` or `ray`, and its link."""
    return next((link, sensor) for link in model.links.values()
                for sensor in link.description.sensors if getattr(sensor, what))
