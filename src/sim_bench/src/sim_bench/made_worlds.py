"""Worlds as public ones are made: many triangles, textures, sensors, rough ground.

Their models are worlds/*.world.xacro; their meshes and pictures are made here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from bullet_sim.formats.xacro.files import expand
from bullet_sim.meshes.part import grid_faces
from run_session.files import find_package

SIGNS = 12
PICTURE_PX = 1024  # a side of a sign's picture
ROUND, PLATE = 0.55, 0.45  # shares of a sign's triangles: post and lamp; its plate
GROUND = 12.0  # m, a side of the playpen's floor
STL_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
CAMERA_TOPICS = tuple(f"/{name}/image_raw" for name in ("front", "left", "rear", "right"))

Surface = tuple[np.ndarray, np.ndarray]  # vertices (n, 3) m, faces (m, 3)


@dataclass(frozen=True)
class MadeWorld:
    """A world file, and what is to be heard of it."""

    file: Path
    topics: tuple[str, ...]


def signs(folder: Path, triangles: int) -> MadeWorld:
    """A road with twelve signs, of `triangles` triangles in all, and a camera before them."""
    each = triangles // SIGNS
    write_stl(folder / "sign.stl", [_turned_on_a_lathe(round(each * ROUND)),
                                    _plate(round(each * PLATE))])
    for number in range(SIGNS):
        cv2.imwrite(str(folder / f"sign_{number}.png"), _picture(number))
    (folder / "signs.material").write_text("".join(
        f"material Sign/{n}\n{{ technique {{ pass {{ texture_unit {{ texture sign_{n}.png }} }} }} "
        f"}}\n" for n in range(SIGNS)), encoding="utf-8")
    return _world(folder, "signs", CAMERA_TOPICS[:1], folder=folder)


def many_eyes(folder: Path) -> MadeWorld:
    """Four cameras and a laser of 16 rings."""
    return _world(folder, "many_eyes", (*CAMERA_TOPICS, "/points"))


def depth(folder: Path, width: int, height: int) -> MadeWorld:
    """A depth camera at 30 Hz: colour, depth and points."""
    topics = ("/camera/rgb/image_raw", "/camera/depth/image_raw", "/camera/depth/points")
    return _world(folder, "depth", topics, width=width, height=height)


def playpen(folder: Path, wheels: int) -> MadeWorld:
    """A skid-steered robot of four or six wheels on a rough floor of triangles."""
    write_stl(folder / "floor.stl", [_rough_floor(20_000)])
    return _world(folder, "playpen", (), folder=folder, wheels=wheels)


def write_stl(path: Path, surfaces: list[Surface]) -> None:
    """As binary STL."""
    corners = np.concatenate([vertices[faces] for vertices, faces in surfaces])
    facets = np.zeros(len(corners), STL_FACET)
    facets["corners"] = corners
    path.write_bytes(bytes(80) + len(facets).to_bytes(4, "little") + facets.tobytes())


def _world(where: Path, name: str, topics: tuple[str, ...], **arguments: object) -> MadeWorld:
    template = find_package("sim_bench") / "worlds" / f"{name}.world.xacro"
    text = expand(template, {key: str(value) for key, value in arguments.items()})
    file = where / f"{name}.world"
    file.write_text(text, encoding="utf-8")
    return MadeWorld(file, topics)


def _turned_on_a_lathe(triangles: int) -> Surface:
    """A post with a ball on it; rings and sides as many as that takes."""
    sides = max(8, math.isqrt(triangles // 2))
    rings = max(4, triangles // (2 * sides))
    bends = np.linspace(-1.5, 1.5707, rings // 2)
    radius = np.concatenate([np.full(rings - len(bends), 0.02), 0.06 * np.cos(bends)])
    height = np.concatenate([np.linspace(0.0, 0.33, rings - len(bends)),
                             0.39 + 0.06 * np.sin(bends)])
    angle = np.linspace(0.0, 2 * math.pi, sides + 1)
    angle[-1] = 0.0  # the same place, to the last bit
    vertices = np.stack([np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)),
                         np.repeat(height[:, None], sides + 1, axis=1)], axis=-1).reshape(-1, 3)
    return vertices, grid_faces(len(radius), sides + 1)


def _plate(triangles: int) -> Surface:
    """Flat, facing x, and yet cut up, as exporters do."""
    z, y = _square(triangles, 0.2)
    return np.stack([0 * y + 0.021, y, z + 0.3], axis=-1).reshape(-1, 3), grid_faces(*y.shape)


def _rough_floor(triangles: int) -> Surface:
    """Gentle waves and bumps of some mm, from a seed."""
    y, x = _square(triangles, GROUND)
    bumps = np.random.default_rng(0).normal(0.0, 0.002, x.shape)
    z = 0.02 * np.sin(1.3 * x) * np.cos(0.9 * y) + bumps
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), grid_faces(*x.shape)


def _square(triangles: int, wide: float) -> list[np.ndarray]:
    """Both coordinates (m) of a grid of `triangles` around 0, the first along its rows."""
    return np.meshgrid(*[np.linspace(-wide / 2, wide / 2, math.isqrt(triangles // 2) + 1)] * 2,
                       indexing="ij")


def _picture(number: int) -> np.ndarray:
    picture = np.full((PICTURE_PX, PICTURE_PX, 3), 255, np.uint8)
    colour = [int(one) for one in np.random.default_rng(number).integers(30, 200, 3)]
    cv2.circle(picture, (PICTURE_PX // 2,) * 2, PICTURE_PX * 4 // 10, colour, PICTURE_PX // 12)
    cv2.putText(picture, str(number), (PICTURE_PX // 4, PICTURE_PX * 2 // 3),
                cv2.FONT_HERSHEY_SIMPLEX, PICTURE_PX / 60, (0, 0, 0), PICTURE_PX // 20)
    return picture
