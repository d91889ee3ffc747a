"""The protocol of renderers, and the choice of one."""

import logging
import math
import os
import time
from collections.abc import Callable
from typing import Protocol

from bullet_sim.description import Box, LightDescription, Plane, Visual
from bullet_sim.errors import SimulationError
from bullet_sim.pose import Pose
from bullet_sim.profiler import Profiler
from bullet_sim.rendering.frame import CameraView, Frame
from bullet_sim.rendering.scene import Scene, SceneState

log = logging.getLogger(__name__)

VARIABLE = "BULLET_SIM_RENDERER"


class Renderer(Protocol):
    """Draws a scene. One call at a time, from any thread."""

    name: str  # backend and device, for users
    largest_px: int  # longest side of an image

    def draw(self, scene: SceneState, view: CameraView, depth: bool = False) -> Frame:
        """One image, and its depth if wanted; the arrays are the caller's own."""
        ...

    def trim(self) -> None:
        """Free the memory of images and of removed models.

        The next images allocate it again.
        """
        ...

    def close(self) -> None:
        """Free all resources; it cannot draw afterwards."""
        ...


def open_renderer(preference: str | None = None, profiler: Profiler | None = None) -> Renderer:
    """EGL if it works, else TinyRenderer with a warning.

    `preference`, "egl" or "tiny", or without it BULLET_SIM_RENDERER, requires that one; if it
    does not work, it is a SimulationError. The cost of drawing is added to `profiler`.
    """
    profiler = profiler or Profiler()
    chosen = preference or os.environ.get(VARIABLE) or None
    if chosen is not None:
        return _open_chosen(chosen, profiler)
    try:
        return _open_egl(profiler)
    except Exception as error:  # no library, driver or device: each raises another type
        reason = " ".join(str(error).split()) or type(error).__name__
    renderer = _open_tiny(profiler)
    rate_hz = 1 / _seconds_per_frame()
    log.warning(
        "no EGL renderer (%s); drawing with %s instead: about %.3g frames/s at 320x240, "
        "a quarter of that at twice the width",
        reason, renderer.name, rate_hz,
    )
    return renderer


def _open_chosen(chosen: str, profiler: Profiler) -> Renderer:
    opener = _OPENERS.get(chosen)
    if opener is None:
        known = ", ".join(_OPENERS)
        raise SimulationError(f"{VARIABLE}={chosen}: no such renderer; there are: {known}")
    try:
        return opener(profiler)
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise SimulationError(f"renderer {chosen} does not start: {reason}") from error


def _open_egl(profiler: Profiler) -> Renderer:
    from bullet_sim.rendering.egl import EglRenderer

    return EglRenderer(profiler)


def _open_tiny(profiler: Profiler) -> Renderer:
    from bullet_sim.rendering.tiny import TinyRenderer

    return TinyRenderer(profiler)


_OPENERS: dict[str, Callable[[Profiler], Renderer]] = {"egl": _open_egl, "tiny": _open_tiny}


def _seconds_per_frame() -> float:
    """The fastest of three small images of a floor and a box."""
    scene = Scene()
    scene.add_light(LightDescription("sun", type="directional"))
    visuals = (
        Visual("floor", Plane((0.0, 0.0, 1.0), (4.0, 4.0))),
        Visual("box", Box((0.3, 0.3, 0.3)), Pose((1.0, 0.0, 0.15))),
    )
    scene.add_link(("trial", "link"), visuals, Pose())
    view = CameraView(320, 240, math.pi / 3, 0.05, 50.0, Pose((-1.0, 0.0, 0.3)))
    renderer, took = _open_tiny(Profiler()), []
    for _ in range(3):
        start = time.perf_counter()
        renderer.draw(scene, view)
        took.append(time.perf_counter() - start)
    renderer.close()
    return min(took)
