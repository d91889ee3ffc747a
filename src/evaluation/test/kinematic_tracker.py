"""A drive without physics and without ROS: the scene's own pictures, the tracker's law, a unicycle.

Some twenty times quicker than the simulator; wheels that slip and messages that come late are not
in it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from ai_robot_tracking.scenes.scene import Scene
from ai_robot_tracking.scenes.world_file import world_text

from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.world import World
from evaluation.lap import Sample
from evaluation.track_score import CAMERA_X, HALF_FOV, TrackScorer

CAMERA_HEIGHT = 0.25        # m
MOST_ACCELERATION = np.array([2.0, 8.0])  # m/s^2, rad/s^2, as the drive's controller allows
Law = Callable[[np.ndarray, float], tuple[float, float]]


def follow(scene: Scene, folder: Path, law: Law, drive: TrackScorer, start: tuple[float, ...],
           size: tuple[int, int] = (320, 240), rate_hz: float = 15.0) -> None:
    """Has `drive` score it until it is over.

    `law(picture, time)` gets BGR pictures (rows, columns, 3) of this size (width, height) and s;
    it answers m/s and rad/s. `start`: x, y (m), yaw (rad). The world file goes to `folder`.
    """
    path = folder / "scene.world"
    path.write_text(world_text(scene), encoding="utf-8")
    world, renderer = World(load_world(path, Resources.from_environment())), open_renderer()
    steps = round(1 / (rate_hz * world.timestep))
    period = steps * world.timestep
    pose, speed = np.array(start, float), np.zeros(2)
    try:
        while not drive.over:
            drive.add(Sample(world.time, *pose.tolist()))
            picture = renderer.draw(world.update_scene(), _view(pose, size)).rgb[:, :, ::-1]
            most = MOST_ACCELERATION * period
            speed += np.clip(law(np.ascontiguousarray(picture), world.time) - speed, -most, most)
            middle = pose[2] + speed[1] * period / 2
            pose += period * np.array([speed[0] * math.cos(middle), speed[0] * math.sin(middle),
                                       speed[1]])
            world.step(steps)
    finally:
        renderer.close()
        world.close()


def _view(pose: np.ndarray, size: tuple[int, int]) -> CameraView:
    x, y, yaw = pose
    place = (x + CAMERA_X * math.cos(yaw), y + CAMERA_X * math.sin(yaw), CAMERA_HEIGHT)
    return CameraView(*size, 2 * HALF_FOV, 0.02, 50.0, Pose.from_xyz_rpy(place, (0.0, 0.0, yaw)))
