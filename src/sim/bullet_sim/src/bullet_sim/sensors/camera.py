"""A camera on a link: colour pictures, and depth along the optical axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bullet_sim.description import CameraDescription, SensorDescription
from bullet_sim.errors import FormatError
from bullet_sim.model import Link
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import Renderer
from bullet_sim.world import World


@dataclass(frozen=True)
class CameraReading:
    """One picture, top row first."""

    time: float  # s, simulated
    rgb: np.ndarray  # (height, width, 3) uint8, RGB
    depth: np.ndarray | None  # (height, width) float32, m along the optical axis; inf: none


class Camera:
    """Gazebo's camera sensor: looks along +x of its sensor frame, z up."""

    def __init__(self, world: World, link: Link, sensor: SensorDescription, renderer: Renderer,
                 number: int = 0):
        if not sensor.cameras:
            raise FormatError(f"sensor {sensor.name} of {link.scoped_name} has no <camera>")
        self.description: CameraDescription = sensor.cameras[number]
        self._world = world
        self._link = link
        self._sensor = sensor
        self._renderer = renderer
        self._random_name = f"{link.scoped_name}::{sensor.name}::{number}"
        if min(self.description.width, self.description.height) < 1:
            raise FormatError(f"sensor {sensor.name} of {link.scoped_name}: an image of "
                              f"{self.description.width}x{self.description.height} px")
        if not 0 < self.description.horizontal_fov < math.pi:
            raise FormatError(f"sensor {sensor.name} of {link.scoped_name}: <horizontal_fov> is "
                              f"{self.description.horizontal_fov}, which is not between 0 and pi")
        self.restart()

    def restart(self) -> None:
        """Draw the noise from the start."""
        self._random = self._world.random(self._random_name)

    def view(self) -> CameraView:
        """The pinhole as it stands now."""
        camera = self.description
        return CameraView(camera.width, camera.height, camera.horizontal_fov, camera.near,
                          camera.far, self._link.pose * self._sensor.pose)

    def sample(self, depth: bool = False) -> CameraReading:
        """Draw what the camera sees."""
        frame = self._renderer.draw(self._world.update_scene(), self.view(), depth)
        return CameraReading(self._world.time, self._with_noise(frame.rgb), frame.depth)

    def _with_noise(self, rgb: np.ndarray) -> np.ndarray:
        noise = self.description.noise
        if noise.type != "gaussian" or (noise.stddev == 0 and noise.mean == 0):
            return rgb
        drawn = self._random.normal(noise.mean * 255, noise.stddev * 255, rgb.shape)
        return np.clip(rgb + drawn, 0, 255).astype(np.uint8)
