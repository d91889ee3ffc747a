"""The protocol of renderers, and opening the one there is: OpenGL without a screen, by EGL."""

from typing import Protocol

from bullet_sim.errors import SimulationError
from bullet_sim.profiler import Profiler
from bullet_sim.rendering.frame import CameraView, Frame
from bullet_sim.rendering.scene import SceneState

PACKAGES = "libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"  # Debian's: EGL, and Mesa's drivers


class NoRenderer(SimulationError):
    """No camera can be drawn on this machine."""


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


def open_renderer(profiler: Profiler | None = None) -> Renderer:
    """The EGL renderer; NoRenderer, which names the packages to install, if it does not start.

    The cost of drawing is added to `profiler`.
    """
    try:
        from bullet_sim.rendering.egl import EglRenderer  # moderngl, which not every program needs

        return EglRenderer(profiler or Profiler())
    except Exception as error:  # no library, driver or device: each raises another type
        reason = " ".join(str(error).split()) or type(error).__name__
        raise NoRenderer(f"cameras cannot be drawn: EGL does not start ({reason}); type: "
                         f"sudo apt-get install {PACKAGES}") from error
