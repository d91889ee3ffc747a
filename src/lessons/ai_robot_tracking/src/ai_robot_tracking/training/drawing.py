"""Images of random worlds by our own renderer, with the boxes of the objects visible in them.

A seed draws a world's objects, their places and the camera. It is rendered three times: as a camera
sees it, with each object in its own flat colour, and each object alone in a view twice as wide. A
box encloses an object's visible pixels. The object is to be found if both sides of its box are at
least 12 px in an image 640 px wide, and at least half of it is visible, neither hidden nor outside
the image. Boxes of all other visible objects are kept, but neither missing nor finding them counts
as an error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.scenery import air, distractor, lamps, surroundings
from ai_robot_tracking.training.things import FACING, MAKERS, Images, Thing, coloured, link_shape
from bullet_sim.description import LightDescription, SceneDescription
from bullet_sim.meshes.part import MeshPart
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import Renderer
from bullet_sim.rendering.scene import Node, Scene

WIDTH_PX = 640
HEIGHTS_PX = (480, 480, 480, 360)  # three of four images are 4:3
APPARENT_PX = (16.0, 420.0)  # height in the image for which an object is placed
EMPTY = 0.06  # share of the worlds with no object of the five classes
SHARES = (0.21, 0.2, 0.16, 0.2, 0.23)  # of the classes; often there is no room for a sign
NEAREST = 0.35  # m between the camera and an object's edge
MOST_TURNED = math.radians(60)  # largest angle of a sign's face from the camera
ATTEMPTS = 12  # to find a free place for an object
SMALLEST_PX = 12  # shorter side of a box, in an image WIDTH_PX wide
LEAST_SEEN = 0.5  # visible share of an object
FEWEST_PIXELS = 8  # needed for a box to be kept
WIDER = 2  # times: width of the view in which a whole object is counted
FIELDS = 6  # class, left, top, right, bottom, counts


@dataclass(frozen=True)
class Stage:
    """One world and the camera in it."""

    view: CameraView
    description: SceneDescription
    lights: list[LightDescription]
    surroundings: tuple[MeshPart, ...]
    things: list[Thing]
    images: Images = field(default_factory=dict)
    grain: float = 0.0  # grey levels, standard deviation of the camera's noise


def make_stage(seed: int) -> Stage:
    """The world of a seed, independent of those of other seeds."""
    rng = np.random.default_rng((0x0B7EC75, seed))
    images: Images = {}
    room = math.exp(rng.uniform(math.log(2.5), math.log(14.0)))
    view = _view(rng)
    around = surroundings(rng, room, images)
    things: list[Thing] = []
    for _ in range(0 if rng.random() < EMPTY else int(rng.integers(2, 9))):
        label = str(rng.choice(CLASSES, p=SHARES))
        _place(rng, MAKERS[label](rng, images), view, room, things)
    for _ in range(int(rng.integers(0, 6))):
        _place(rng, distractor(rng, images), view, room, things)
    grain = float(rng.uniform(0, 5)) if rng.random() < 0.6 else 0.0
    return Stage(view, air(rng), lamps(rng), around, things, images, grain)


def _view(rng: np.random.Generator) -> CameraView:
    height_px = HEIGHTS_PX[int(rng.integers(len(HEIGHTS_PX)))]
    high = math.exp(rng.uniform(math.log(0.08), math.log(1.6)))
    tilt = (rng.normal(0, 0.015), rng.uniform(-0.12, 0.2), 0.0)  # nose down is positive
    pose = Pose.from_xyz_rpy((0.0, 0.0, high), tilt)
    return CameraView(WIDTH_PX, height_px, rng.uniform(0.9, 1.5), 0.05, 100.0, pose)


def _place(
    rng: np.random.Generator, thing: Thing, view: CameraView, room: float, things: list[Thing]
) -> None:
    """Add the object where it is clear of the others; omit it if there is no room."""
    parts = (*thing.own, *thing.support)
    tall = max(float(part.vertices[:, 2].max()) for part in parts)
    own_tall = float(np.ptp(np.concatenate([part.vertices[:, 2] for part in thing.own])))
    for _ in range(ATTEMPTS):
        apparent = math.exp(rng.uniform(*np.log(APPARENT_PX)))
        away = view.focal_length_px * own_tall / apparent
        away = min(max(away, NEAREST + thing.reach), room - thing.reach - 0.2)
        bearing = rng.uniform(-0.52, 0.52) * view.horizontal_fov
        x, y = away * math.cos(bearing), away * math.sin(bearing)
        if away < NEAREST + thing.reach or any(_meets(thing, x, y, other) for other in things):
            continue
        if thing.label and not _in_view(view, tall - own_tall / 2, away):
            continue
        if thing.label in FACING:
            yaw = bearing + math.pi + rng.uniform(-MOST_TURNED, MOST_TURNED)
        else:
            yaw = rng.uniform(-math.pi, math.pi)
        lift = 0.0
        if thing.label in FACING and tall < 1.0 and rng.random() < 0.3:
            lift = rng.uniform(0, 0.5)
        things.append(replace(thing, pose=Pose.from_xyz_rpy((x, y, lift), (0, 0, yaw))))
        return


def _in_view(view: CameraView, height: float, away: float) -> bool:
    """Whether an object's centre, `height` m above the floor, is within the image's rows."""
    _, tilt, _ = view.pose.rpy()
    row = math.tan(math.atan2(height - view.pose.position[2], away) + tilt) * view.focal_length_px
    return abs(row) < view.height / 2


def _meets(thing: Thing, x: float, y: float, other: Thing) -> bool:
    ox, oy, _ = other.pose.position
    return math.hypot(x - ox, y - oy) < thing.reach + other.reach


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
