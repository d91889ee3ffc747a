"""A camera on a link: colour images, and depth along the optical axis."""

import logging
import math
from dataclasses import dataclass, replace

import numpy as np

from bullet_sim.description import WIDE_ANGLE, CameraDescription, SensorDescription
from bullet_sim.errors import FormatError
from bullet_sim.link import Link
from bullet_sim.rendering.frame import LARGEST_SQUARE_PX, CameraView, drawable_size
from bullet_sim.rendering.renderer import Renderer
from bullet_sim.rendering.scene import Look, SceneState
from bullet_sim.sensors.image_effects import Distortion, ImageNoise
from bullet_sim.sensors.wide_lens import WideLens, mistake_in_lens
from bullet_sim.world import World

log = logging.getLogger(__name__)

DEFAULT_RATE = 30.0  # Hz, where neither sensor nor plugin names one (Gazebo: as fast as it can)


@dataclass(frozen=True)
class CaptureState:
    """All that an image is made from, as it was at one moment. It never changes."""

    time: float  # s, simulated
    tick: int
    scene: SceneState
    view: CameraView


@dataclass(frozen=True)
class CameraReading:
    """One image, top row first."""

    time: float  # s, simulated
    rgb: np.ndarray  # (height, width, 3) uint8, RGB
    depth: np.ndarray | None  # (height, width) float32, m along the optical axis; inf: none


@dataclass(frozen=True, eq=False)
class _Picture:
    """A drawn image before noise, and what it shows."""

    look: Look
    view: CameraView
    with_depth: bool  # which also changes the details of colour images
    rgb: np.ndarray  # as in CameraReading; read-only
    depth: np.ndarray | None

    def shows(self, look: Look, view: CameraView, with_depth: bool) -> bool:
        return (self.with_depth == with_depth and self.view == view and self.look.equals(look))


class Camera:
    """Gazebo's camera sensor: looks along +x of its sensor frame, z up.

    A `<distortion>` distorts the colours, not the depth, which stays a pinhole's. While it sees
    the same, to the last bit, it is not drawn again; noise is added to each image.
    FormatError without a <camera>, and for an image that cannot be drawn.
    """

    def __init__(self, world: World, link: Link, sensor: SensorDescription, renderer: Renderer,
                 number: int = 0, border_crop: bool = True):
        if not sensor.cameras:
            raise FormatError(f"sensor {sensor.name} of {link.scoped_name} has no <camera>")
        where = f"sensor {sensor.name} of {link.scoped_name}"
        self.description = _drawable(sensor.cameras[number], renderer, where)
        self._world = world
        self._link = link
        self._sensor = sensor
        self._renderer = renderer
        self._name = f"{link.scoped_name}::{sensor.name}::{number}"
        self.wide_angle = sensor.type == WIDE_ANGLE
        self._border_crop = border_crop
        mistake = _mistake(self.description, renderer, self.wide_angle)
        if mistake:
            raise FormatError(f"{where}: {mistake}")
        self._noise: ImageNoise | None = None
        self._distortion: Distortion | None = None
        self._lens: WideLens | None = None
        self._last: _Picture | None = None

    def view(self) -> CameraView:
        """The pinhole camera at its current pose."""
        camera = self.description
        return CameraView(camera.width, camera.height, camera.horizontal_fov, camera.near,
                          camera.far, self._link.pose * self._sensor.pose * camera.pose)

    def sample(self, depth: bool = False) -> CameraReading:
        """The current image; its arrays are the caller's own."""
        reading = self.render(self.capture(), depth)
        rgb = reading.rgb if reading.rgb.flags.writeable else reading.rgb.copy()
        metres = None if reading.depth is None else reading.depth.copy()
        return CameraReading(reading.time, rgb, metres)

    def capture(self) -> CaptureState:
        """The state for an image, not yet drawn. For the thread that owns the world."""
        world = self._world
        with world.profiler.measure("scene"):
            return CaptureState(world.time, world.tick, world.update_scene().frozen(), self.view())

    def render(self, state: CaptureState, depth: bool = False,
               anew: bool = False) -> CameraReading:
        """Draw a captured state, from any thread, one at a time, even while the world steps.

        A wide-angle camera has no depth. Unless it is to be drawn `anew`, an image that shows the
        same as the last one has the same arrays: colours without noise are read-only, depth keeps
        what was written to it.
        """
        look, last = state.scene.look(), self._last
        if anew or last is None or not last.shows(look, state.view, depth):
            self._last = last = None  # its memory is free for the next one
            self._last = last = _Picture(look, state.view, depth, *self._draw(state, depth))
        return CameraReading(state.time, self._with_noise(last.rgb, state), last.depth)

    def _draw(self, state: CaptureState, depth: bool) -> tuple[np.ndarray, np.ndarray | None]:
        """Colours without noise, read-only, and depth, as in CameraReading."""
        if self.wide_angle:
            rgb, metres = self._through_lens(state), None
        else:
            frame = self._renderer.draw(state.scene, state.view, depth)
            rgb, metres = self._bent(frame.rgb, state), frame.depth
        rgb.setflags(write=False)
        return rgb, metres

    def _through_lens(self, state: CaptureState) -> np.ndarray:
        if self._lens is None:
            self._lens = WideLens(self.description)
        return self._lens.draw(state.view.pose,
                               lambda view: self._renderer.draw(state.scene, view).rgb)

    def _bent(self, rgb: np.ndarray, state: CaptureState) -> np.ndarray:
        if not any(self.description.distortion):
            return rgb
        with self._world.profiler.measure("distortion"):
            if self._distortion is None:
                self._distortion = Distortion(self.description, state.view.focal_length_px,
                                              self._border_crop)
            return self._distortion.apply(rgb)

    def _with_noise(self, rgb: np.ndarray, state: CaptureState) -> np.ndarray:
        noise = self.description.noise
        if noise.type != "gaussian" or (noise.stddev == 0 and noise.mean == 0):
            return rgb
        with self._world.profiler.measure("noise"):
            if self._noise is None:
                self._noise = ImageNoise(noise, rgb.shape, self._world.random(self._name, 0))
            return self._noise.add(rgb, self._world.random(self._name, state.tick))


def _drawable(camera: CameraDescription, renderer: Renderer, where: str) -> CameraDescription:
    """The same, with a smaller image if it is too large to be drawn, and a line in the log."""
    width, height = camera.width, camera.height
    if min(width, height) < 1:
        return camera
    drawn = drawable_size(width, height, renderer.largest_px)
    if drawn == (width, height):
        return camera
    log.warning("%s: an image of %dx%d px is not drawn, at most %d per side and %dx%d in all; "
                "%dx%d is used", where, width, height, renderer.largest_px,
                LARGEST_SQUARE_PX, LARGEST_SQUARE_PX, *drawn)
    return replace(camera, width=drawn[0], height=drawn[1])


def _mistake(camera: CameraDescription, renderer: Renderer, wide_angle: bool) -> str | None:
    """Why a camera cannot be drawn; None if it can."""
    if min(camera.width, camera.height) < 1:
        return f"an image of {camera.width}x{camera.height} px"
    side_px = min(renderer.largest_px, LARGEST_SQUARE_PX)
    wrong_lens = mistake_in_lens(camera, side_px) if wide_angle else None
    if wrong_lens:
        return wrong_lens
    if not wide_angle and not 0 < camera.horizontal_fov < math.pi:
        return f"<horizontal_fov> is {camera.horizontal_fov}, which is not between 0 and pi"
    if not 0 < camera.near < camera.far < math.inf:
        return (f"<clip> is from {camera.near} to {camera.far} m; it needs a <near> of more than 0 "
                "and a <far> beyond it")
    return None


def pictures_rate(sensor_hz: float, plugin_hz: float) -> float:
    """The sensor's `<update_rate>`, thinned to the plugin's `<updateRate>`, Hz; 0: there is none.

    Only whole frames can be skipped (gazebo_ros_camera.cpp, OnNewFrame): 30 Hz thinned to 20 is 15.
    """
    if sensor_hz > 0 and plugin_hz > 0:
        return sensor_hz / max(1, math.ceil(sensor_hz / plugin_hz - 1e-9))
    return max(sensor_hz, plugin_hz) or DEFAULT_RATE
