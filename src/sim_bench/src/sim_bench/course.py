"""The course of learning_topic with its waffle, in the core alone: the scene that is measured."""

from __future__ import annotations

import os
from pathlib import Path

import rospkg
from racecar_description.track.closed_line import Track, load_track

from bullet_sim.description import SensorDescription
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xacro.files import expand
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.world import World

SETTLING_STEPS = 300
# The tags of the waffle's drive plugin: what a learner's waffle is driven with.
WAFFLE_DRIVE = DiffDriveParameters(0.287, 0.066, 1.0, 10.0)


class CourseWorld:
    """The world of 0course.launch. Close it: the engine holds a fixed number of worlds."""

    def __init__(self) -> None:
        self._packages = rospkg.RosPack()
        lessons = Path(self._packages.get_path("learning_topic"))
        self._resources = Resources.from_environment(
            os.environ,
            extra_model_paths=[lessons / "models"],
            extra_resource_paths=[lessons],
            find_package=self._packages.get_path,
        )
        world_file = lessons / "worlds" / "course.world"
        self.world = World(load_world(world_file, self._resources))
        self.track: Track = load_track(
            Path(self._packages.get_path("evaluation")) / "tracks" / "course.yaml"
        )
        self._waffle_text = ""

    def spawn_waffle(self, name: str = "turtlebot3_waffle", pose: Pose = Pose()) -> Model:
        """A waffle, standing still on its wheels."""
        if not self._waffle_text:
            folder = Path(self._packages.get_path("turtlebot3_description"))
            self._waffle_text = expand(
                folder / "urdf" / "turtlebot3_waffle.urdf.xacro",
                find_package=self._packages.get_path,
            )
        description = load_model(self._waffle_text, self._resources)
        model = self.world.spawn(description, pose, name)
        self.world.step(SETTLING_STEPS)
        return model

    def put_on_line(self, waffle: Model, share: float) -> None:
        """Stand the waffle on the yellow line, this share (0..1) of a lap from the start."""
        x, y, heading = self.track.pose(share * self.track.length)
        height = waffle.pose.position[2]
        waffle.set_pose(Pose.from_xyz_rpy((x, y, height), (0.0, 0.0, heading)))

    def view(self, waffle: Model, width: int, height: int) -> CameraView:
        """What the waffle's camera sees now, with another number of pixels."""
        link, sensor = _sensor_with(waffle, "cameras")
        camera = sensor.cameras[0]
        pose = link.pose * sensor.pose
        return CameraView(width, height, camera.horizontal_fov, camera.near, camera.far, pose)

    def close(self) -> None:
        """Let go of the engine."""
        self.world.close()


def drive_of(waffle: Model) -> DiffDrive:
    """The waffle's two driven wheels, as its drive plugin has them."""
    return DiffDrive(
        waffle.joint("wheel_left_joint"), waffle.joint("wheel_right_joint"), WAFFLE_DRIVE
    )


def laser_of(waffle: Model) -> tuple[Link, SensorDescription]:
    """Link and description of the waffle's laser."""
    return _sensor_with(waffle, "ray")


def _sensor_with(model: Model, what: str) -> tuple[Link, SensorDescription]:
    for link in model.links.values():
        for sensor in link.description.sensors:
            if getattr(sensor, what):
                return link, sensor
    raise LookupError(f"model {model.name} has no sensor with {what}")
