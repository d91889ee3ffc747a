"""Images by our own renderer, with the boxes of the objects visible in them.

Each world is rendered three times: as a camera sees it, with each object in its own flat colour,
and each object alone in a view twice as wide. A box encloses an object's visible pixels. The object
is to be found if both sides of its box are at least 12 px in an image 640 px wide, and at least
half of it is visible, neither hidden nor outside the image. Boxes of all other visible objects are
kept, but neither missing nor finding them counts as an error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np

from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.staging import WIDTH_PX, Stage, make_stage
from ai_robot_tracking.training.things import Thing, coloured, link_shape
from bullet_sim.meshes.part import MeshPart
from bullet_sim.pose import IDENTITY
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import Renderer
from bullet_sim.rendering.scene import Node, Scene

SMALLEST_PX = 12  # shorter side of a box, in an image WIDTH_PX wide
LEAST_SEEN = 0.5  # visible share of an object
FEWEST_PIXELS = 8  # needed for a box to be kept
WIDER = 2  # times: width of the view in which a whole object is counted
FIELDS = 6  # class, left, top, right, bottom, counts


@dataclass(frozen=True)
class Picture:
    """One image and the objects in it."""

    rgb: np.ndarray  # (h, w, 3) uint8
    labels: np.ndarray  # (n, FIELDS) float32: class, left, top, right, bottom (px), counts (0, 1)


def draw_picture(renderer: Renderer, seed: int) -> Picture:
    """The image of a seed's world, with the camera's noise."""
    return draw_stage(renderer, make_stage(seed), seed)


def draw_stage(renderer: Renderer, stage: Stage, seed: int) -> Picture:
    """The image of a stage; the seed is for the noise."""
    rgb = renderer.draw(_scene(stage), stage.view).rgb
    owners = renderer.draw(_flat(stage.things, stage.surroundings), stage.view).rgb[..., 0]
    labels = []
    for number, thing in enumerate(stage.things, start=1):
        seen = owners == number
        if thing.label is None or int(seen.sum()) < FEWEST_PIXELS:
            continue
        labels.append(_label(thing, seen, _pixels_alone(renderer, thing, stage.view)))
    return Picture(_noisy(rgb, stage.grain, seed),
                   np.array(labels, np.float32).reshape(-1, FIELDS))


def _label(thing: Thing, seen: np.ndarray, whole: float) -> tuple[float, ...]:
    columns, rows = np.flatnonzero(seen.any(axis=0)), np.flatnonzero(seen.any(axis=1))
    left, right, top, bottom = columns[0], columns[-1] + 1, rows[0], rows[-1] + 1
    large = min(right - left, bottom - top) >= SMALLEST_PX * seen.shape[1] / WIDTH_PX
    counts = large and seen.sum() >= LEAST_SEEN * whole
    return CLASSES.index(thing.label), left, top, right, bottom, float(counts)


def _pixels_alone(renderer: Renderer, thing: Thing, view: CameraView) -> float:
    """How many pixels (at the image's scale) the object would have with nothing in front of it."""
    fov = 2 * math.atan(WIDER * math.tan(view.horizontal_fov / 2))
    wide = replace(view, horizontal_fov=fov)
    alone = renderer.draw(_flat([replace(thing, support=())], ()), wide)
    return float(np.count_nonzero(alone.rgb[..., 0])) * WIDER**2


def _scene(stage: Stage) -> Scene:
    scene = Scene(stage.description)
    for light in stage.lights:
        scene.add_light(light)
    scene.images = stage.images
    groups = [(stage.surroundings, IDENTITY)]
    groups += [((*thing.own, *thing.support), thing.pose) for thing in stage.things]
    for number, (parts, pose) in enumerate(groups):
        scene.nodes[str(number), "link"] = Node(link_shape(parts), pose)
    return scene


def _flat(things: list[Thing], surroundings: tuple[MeshPart, ...]) -> Scene:
    """Object n in red n of 255, everything else black."""
    scene = Scene()
    scene.description = replace(scene.description, background=(0.0, 0.0, 0.0, 1.0))
    if surroundings:
        scene.nodes["around", "link"] = Node(link_shape(_painted(surroundings, 0)), IDENTITY)
    for number, thing in enumerate(things, start=1):
        parts = (*_painted(thing.own, number), *_painted(thing.support, 0))
        scene.nodes[str(number), "link"] = Node(link_shape(parts), thing.pose)
    return scene


def _painted(parts: tuple[MeshPart, ...], number: int) -> tuple[MeshPart, ...]:
    paint = replace(coloured((number / 255, 0.0, 0.0)), lighting=False, emissive=(0, 0, 0, 1))
    return tuple(replace(part, material=paint) for part in parts)


def _noisy(rgb: np.ndarray, grain: float, seed: int) -> np.ndarray:
    if grain <= 0:
        return rgb
    rng = np.random.default_rng((0x6A1, seed))
    noise = rng.standard_normal((rgb.shape[0] // 2, rgb.shape[1], 3), np.float32) * grain
    noise = np.concatenate([noise, noise[::-1, ::-1]])  # half the noise, used twice, costs half
    return cv2.add(rgb, noise, dtype=cv2.CV_8U)
