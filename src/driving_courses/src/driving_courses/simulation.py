"""A robot on a course in the simulator's core, stepped from picture to picture."""

from __future__ import annotations

import math
import os
from dataclasses import replace

import cv2
import numpy as np

from bullet_sim.description import ModelDescription, Noise, WorldDescription
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xml_values import parse_xml
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim.pose import Pose
from bullet_sim.rendering.renderer import Renderer, open_renderer
from bullet_sim.sensors.camera import Camera, pictures_rate
from bullet_sim.tick_rate import TickRate
from bullet_sim.world import World
from driving_courses.course import CourseSpec
from driving_courses.drives import DRIVES
from driving_courses.errors import CourseError
from driving_courses.packages import find_file
from driving_courses.randomisation import Episode
from driving_courses.resources import package_folder, resources
from evaluation.lap import Sample

_THREADS = "LP_NUM_THREADS"  # of Mesa's llvmpipe, which reads it while it is opened
_SMALL = 320 * 240  # px of a picture that is drawn sooner than threads are woken for it
_drawing: set[int] = set()  # processes that have opened a renderer; a forked one has its parent's


class Simulation:
    """The world is built anew for each episode, so that nothing of the last one is left in it.

    The renderer is opened with the first episode: until then a process may be forked.
    """

    def __init__(self, course: CourseSpec, size: tuple[int, int], timestep: float | None = None):
        """`size`: width and height of the camera's pictures, px; `timestep`: of the engine, s,
        None: as the world says."""
        self._course, self._size, self._timestep = course, size, timestep
        text = expand(find_file(course.robot), find_package=package_folder)
        self._urdf = parse_xml(text, course.robot)
        self._robot = load_model(text, resources(course))
        self._settings = find_file(course.settings) if course.settings else None
        self._renderer: Renderer | None = None
        self._world: World | None = None
        sensor = next(s for link in self._robot.links for s in link.sensors if s.cameras)
        tags = PluginParameters(self._robot.name, sensor.plugins[0])
        self.rate_hz = pictures_rate(sensor.update_rate, tags.number("updateRate", 0.0))

    def begin(self, world: WorldDescription, start: tuple[float, float, float],
              episode: Episode) -> None:
        """The robot stands at `start` (x, y in m, yaw in rad); go on to the first picture."""
        self._end()
        if self._renderer is None:
            self._renderer = _open_renderer(math.prod(self._size))
        said = episode.start
        self._gain = max(1.0, said.light)
        world = _disturbed(world, said.light, episode.friction)
        if self._timestep is not None:
            world = replace(world, physics=replace(world.physics, max_step_size=self._timestep))
        self._world = World(world, episode.seed)
        x, y, yaw = start
        self._model = self._world.spawn(
            _with_friction(self._robot, episode.friction),
            Pose.from_xyz_rpy((x, y, 0.0), (0.0, 0.0, yaw)), self._course.model)
        self._drive = DRIVES[self._course.drive](
            self._world, self._model, self._urdf, self._settings)
        self._pictures = TickRate(self.rate_hz, self._world.timestep, self._world.tick)
        self._camera = self._open_camera(said.camera_noise)
        self._advance()

    def drive(self, speed: float, turn: float, ackermann: bool) -> None:
        """Command m/s and rad/s or, `ackermann`, rad of a bicycle's front wheel; go on to the next
        picture. As in ROS, the wheels take the command when the simulator next updates them."""
        base = self._course.wheelbase
        if ackermann and not self._drive.steers:
            turn = speed * math.tan(turn) / base
        elif self._drive.steers and not ackermann:
            turn = math.atan(turn * base / speed) if speed else 0.0
        self._drive.command(speed, turn)
        self._advance()

    def picture(self) -> np.ndarray:
        """What the camera sees now, (height, width, 3) uint8 RGB."""
        rgb = self._camera.sample().rgb
        return rgb if self._gain == 1.0 else cv2.convertScaleAbs(rgb, alpha=self._gain)

    def sample(self) -> Sample:
        """Where the robot is now."""
        pose = self._model.pose
        return Sample(self._world.time, *pose.position[:2], pose.rpy()[2])

    def close(self) -> None:
        """Let go of the engine and the renderer."""
        self._end()
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None

    def _advance(self) -> None:
        self._drive.run(self._pictures.next_tick(self._world.tick))

    def _end(self) -> None:
        if self._world is not None:
            self._world.close()
            self._world = None

    def _open_camera(self, noise: float) -> Camera:
        link, sensor = next((link, sensor) for link in self._model.links.values()
                            for sensor in link.description.sensors if sensor.cameras)
        camera = replace(sensor.cameras[0], width=self._size[0], height=self._size[1],
                         noise=Noise("gaussian", stddev=noise) if noise else Noise())
        return Camera(self._world, link, replace(sensor, cameras=(camera,)), self._renderer)


def _open_renderer(pixels: int) -> Renderer:
    """A renderer for pictures of `pixels` pixels.

    CourseError in a process that was forked from one that draws: OpenGL would wait for ever.
    """
    if _drawing - {os.getpid()}:
        raise CourseError("this process was forked from one that has drawn pictures; start it "
                          "otherwise: vector_kwargs={'context': 'spawn'}")
    _drawing.add(os.getpid())
    own_choice = _THREADS in os.environ or pixels > _SMALL
    if not own_choice:
        os.environ[_THREADS] = "0"
    try:
        return open_renderer()
    finally:
        if not own_choice:
            del os.environ[_THREADS]


def _disturbed(world: WorldDescription, light: float, friction: float) -> WorldDescription:
    """Other light and friction. More light than full shows in the picture alone (`_gain`): like
    Gazebo's, the renderer cuts the light on a surface off at 1 before it multiplies the texture."""
    if light != 1.0:
        scene = replace(world.scene, ambient=_scaled(world.scene.ambient, light))
        lamps = tuple(replace(lamp, diffuse=_scaled(lamp.diffuse, light)) for lamp in world.lights)
        world = replace(world, scene=scene, lights=lamps)
    return replace(world, models=tuple(_with_friction(each, friction) for each in world.models))


def _scaled(colour: tuple[float, ...], factor: float) -> tuple[float, ...]:
    return (*(part * factor for part in colour[:3]), colour[3])


def _with_friction(model: ModelDescription, factor: float) -> ModelDescription:
    if factor == 1.0:
        return model
    return replace(model, links=tuple(
        replace(link, collisions=tuple(
            replace(each, surface=replace(each.surface, mu=each.surface.mu * factor,
                                          mu2=each.surface.mu2 * factor))
            for each in link.collisions))
        for link in model.links))
