"""A random world for one image: its objects, their places and the camera, all from a seed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.scenery import air, distractor, lamps, surroundings
from ai_robot_tracking.training.things import FACING, MAKERS, Images, Thing
from bullet_sim.description import LightDescription, SceneDescription
from bullet_sim.meshes.part import MeshPart
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView

WIDTH_PX = 640
HEIGHTS_PX = (480, 480, 480, 360)  # three of four images are 4:3
APPARENT_PX = (16.0, 420.0)  # height in the image for which an object is placed
EMPTY = 0.06  # share of the worlds with no object of the five classes
SHARES = (0.21, 0.2, 0.16, 0.2, 0.23)  # of the classes; often there is no room for a sign
NEAREST = 0.35  # m between the camera and an object's edge
MOST_TURNED = math.radians(60)  # largest angle of a sign's face from the camera
ATTEMPTS = 12  # to find a free place for an object


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
