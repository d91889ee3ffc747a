"""The scene's lights as the bytes of the shader's `Lights` block."""

import logging
import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from bullet_sim.description import LightDescription
from bullet_sim.pose import rotate
from bullet_sim.rendering.scene import SceneState
from bullet_sim.rendering.shaders import DIRECTIONAL, MAX_LIGHTS, POINT, SPOT

log = logging.getLogger(__name__)

_KINDS = {"directional": DIRECTIONAL, "point": POINT, "spot": SPOT}
EYE_OFFSET = 16  # bytes, of the camera's position in the block


@lru_cache(maxsize=64)
def warn_once(text: str) -> None:
    """Log it; not again whenever a light changes."""
    log.warning("%s", text)


def lights_block(scene: SceneState) -> bytes:
    """Everything but the camera's position; lights beyond the eighth are left out."""
    if len(scene.lights) > MAX_LIGHTS:
        left_out = ", ".join(list(scene.lights)[MAX_LIGHTS:])
        warn_once(f"more than {MAX_LIGHTS} lights; left out: {left_out}")
    block = np.zeros((2 + 6 * MAX_LIGHTS, 4), np.float32)
    block[0] = scene.description.ambient
    for index, light in enumerate(_in_block(scene)):
        block[2 + 6 * index:8 + 6 * index] = _rows(light)
    return block.tobytes()


def kinds(scene: SceneState,
          casting: Sequence[LightDescription]) -> tuple[tuple[int, int], ...]:
    """For each light in the block, its kind, and its index among those `casting` shadows; -1: none.

    At least one: the rest of the block is dark.
    """
    found = [(_kind(light), casting.index(light) if light in casting else -1)
             for light in _in_block(scene)]
    return tuple(found or [(DIRECTIONAL, -1)])


def _in_block(scene: SceneState) -> list[LightDescription]:
    """Sorted by kind, so that scenes with the same kinds of lights use the same shaders."""
    return sorted(list(scene.lights.values())[:MAX_LIGHTS], key=_kind)


def needs_pixels(scene: SceneState) -> bool:
    """Whether a light is near enough for its intensity to vary across a face."""
    return any(light.type != "directional" for light in scene.lights.values())


def strongest_highlight(scene: SceneState) -> float:
    """The brightest specular channel of all lights, 0..1."""
    return max((max(light.specular[:3]) for light in scene.lights.values()), default=0.0)


def light_direction(light: LightDescription) -> np.ndarray:
    """(3,) unit vector of its direction in the world; down if the light's has no length."""
    direction = np.array(rotate(light.pose.orientation, light.direction))
    length = np.linalg.norm(direction)
    return direction / length if 0 < length < np.inf else np.array([0.0, 0.0, -1.0])


def _kind(light: LightDescription) -> int:
    return _KINDS.get(light.type, POINT)


def _rows(light: LightDescription) -> np.ndarray:
    return np.array([
        (*light.pose.position, 0.0),
        (*light_direction(light), light.range),
        light.diffuse,
        light.specular,
        (light.constant, light.linear, light.quadratic, 0.0),
        (math.cos(light.inner_angle / 2), math.cos(light.outer_angle / 2), light.falloff, 0.0),
    ], np.float32)
