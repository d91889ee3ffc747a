"""Worlds of the simulator: a heap, stacks, and the terrain of heightmap.world.

The heap is the same every time: its generator has a fixed seed.
"""

import math
import random
from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement

import cv2
import numpy as np

from bullet_sim.props import add_model, document

DATA = "src/sim/bullet_sim/src/bullet_sim/data"
TERRAIN = "media/materials/textures/heightmap_bowl.png"  # Gazebo has its own image there
SEED = 1
PIECES = 60
DENSITY = 2000.0  # kg/m^3, of concrete
HALF_WIDTH = 2.0  # m, of the heap
SIDE = 129  # px of the terrain image, and m of the ground: one pixel is a metre
TALLEST = 10.0  # m, height of white
FLAT = 10.0  # m around the origin that are level


def rubble() -> str:
    """Pieces that fall into a heap: four per layer, so that they start apart."""
    rng = random.Random(SEED)
    models = []
    for number in range(PIECES):
        layer, corner = divmod(number, 4)
        x = (corner % 2 - 0.5) * HALF_WIDTH + rng.uniform(-0.4, 0.4)
        y = (corner // 2 - 0.5) * HALF_WIDTH + rng.uniform(-0.4, 0.4)
        pose = [x, y, 0.4 + 0.8 * layer, *(rng.uniform(-0.3, 0.3) for _ in range(2)),
                rng.uniform(-math.pi, math.pi)]
        if number % 3:
            size = [round(rng.uniform(*limits), 2) for limits in ((0.3, 0.9), (0.2, 0.6),
                                                                  (0.1, 0.3))]
            mass = DENSITY * math.prod(size)
            models.append((f"box_{number}", _body(pose, mass, "Grey", box=size)))
        else:
            radius, length = round(rng.uniform(0.05, 0.15), 2), round(rng.uniform(0.3, 0.8), 2)
            mass = DENSITY * math.pi * radius ** 2 * length
            models.append((f"cylinder_{number}",
                           _body(pose, mass, "Bricks", cylinder=[radius, length])))
    return _world(models)


def stacks() -> str:
    """Towers of five boxes, spheres and thin cylinders of 1 m and 1 kg."""
    models = []
    for number in range(1, 6):
        for name, x, y, shape in (
                (f"box_{number}", 0, 0, {"box": [1, 1, 1]}),
                (f"sphere_{number}", 0, 1.5, {"sphere": 0.5}),
                (f"sphere_{number}a", 1.5, 1.5, {"sphere": 0.5}),
                (f"cylinder_{number}", 0, -1.5, {"cylinder": [0.1, 1]})):
            models.append((name, _body([x, y, number - 0.5], 1, "WoodPallet", **shape)))
    return _world(models)


def _body(pose: list[float], mass: float, look: str, **shape: float | list[float]) -> dict:
    """A table as in bullet_sim/props.py."""
    return {"pose": pose, "mass": mass, "parts": [{**shape, "look": f"Gazebo/{look}"}]}


def _world(models: Iterable[tuple[str, dict]]) -> str:
    """A world with models by name, the sun and a ground plane."""
    sdf = Element("sdf", version="1.6")
    world = SubElement(sdf, "world", name="default")
    for name in ("sun", "ground_plane"):
        SubElement(SubElement(world, "include"), "uri").text = f"model://{name}"
    for name, table in models:
        add_model(world, name, table)
    return document(sdf, "tools/makers")


def terrain() -> np.ndarray:
    """(SIDE, SIDE) uint16 grey values: level in the middle, rising in waves to the rim."""
    return np.array([[round(65535 * _height(column - SIDE // 2, SIDE // 2 - row) / TALLEST)
                      for column in range(SIDE)] for row in range(SIDE)], np.uint16)


def _height(x: float, y: float) -> float:
    """Height of the bowl, m."""
    out = min(1.0, max(0.0, (math.hypot(x, y) - FLAT) / (SIDE / 2)))
    waves = math.sin(x / 7) * math.cos(y / 9)
    return (7.5 + waves) * out * out * (3 - 2 * out)


def files() -> dict[str, bytes]:
    """The files' bytes by path in the repository."""
    picture = cv2.imencode(".png", terrain(), [cv2.IMWRITE_PNG_COMPRESSION, 9])[1]
    return {f"{DATA}/worlds/rubble.world": rubble().encode(),
            f"{DATA}/worlds/stacks.world": stacks().encode(),
            f"{DATA}/{TERRAIN}": picture.tobytes()}
