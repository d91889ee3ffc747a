#!/usr/bin/env python3
"""Writes data/worlds/rubble.world (a heap of boxes and cylinders), stacks.world and the terrain
image of heightmap.world.

    python3 src/sim/bullet_sim/scripts/make_worlds.py

The heap is the same every time: its generator has a fixed seed.
"""

import math
import random
from pathlib import Path

import cv2
import numpy as np

DATA = Path(__file__).resolve().parents[1] / "src/bullet_sim/data"
WORLDS = DATA / "worlds"
TERRAIN = "media/materials/textures/heightmap_bowl.png"  # where Gazebo has the one of its own
SEED = 1
PIECES = 60
DENSITY = 2000.0  # kg/m^3, of concrete
HALF_WIDTH = 2.0  # m, of the heap
HEAD = """<?xml version="1.0"?>
<!-- Written by make_worlds.py. -->
<sdf version="1.6">
  <world name="default">
    <include>
      <uri>model://sun</uri>
    </include>
    <include>
      <uri>model://ground_plane</uri>
    </include>
"""
TAIL = "  </world>\n</sdf>\n"
MODEL = """    <model name="{name}">
      <pose>{pose}</pose>
      <link name="link">
        <inertial>
          <mass>{mass:.4g}</mass>
          <inertia><ixx>{xx:.4g}</ixx><iyy>{yy:.4g}</iyy><izz>{zz:.4g}</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>
        </inertial>
        <collision name="collision">
          <geometry>{shape}</geometry>
        </collision>
        <visual name="visual">
          <geometry>{shape}</geometry>
          <material><script><uri>file://media/materials/scripts/gazebo.material</uri><name>Gazebo/{look}</name></script></material>
        </visual>
      </link>
    </model>
"""
SIDE = 129  # px of the terrain image, and m of the ground: one pixel is a metre
TALLEST = 10.0  # m, of white
FLAT = 10.0  # m round the origin that are level


def box(name: str, pose: list[float], size: list[float], mass: float, look: str) -> str:
    """A box model; `size` in m, `pose` x, y, z, roll, pitch, yaw in m and rad."""
    x, y, z = size
    return _model(name, pose, f"<box><size>{_numbers(size)}</size></box>", mass, look,
                  [mass * (y * y + z * z) / 12, mass * (x * x + z * z) / 12,
                   mass * (x * x + y * y) / 12])


def cylinder(name: str, pose: list[float], radius: float, length: float, mass: float,
             look: str) -> str:
    """A cylinder model, its axis along its own z."""
    shape = f"<cylinder><radius>{radius:g}</radius><length>{length:g}</length></cylinder>"
    across = mass * (3 * radius ** 2 + length ** 2) / 12
    return _model(name, pose, shape, mass, look, [across, across, mass * radius ** 2 / 2])


def sphere(name: str, pose: list[float], radius: float, mass: float, look: str) -> str:
    """A ball model."""
    return _model(name, pose, f"<sphere><radius>{radius:g}</radius></sphere>", mass, look,
                  [0.4 * mass * radius ** 2] * 3)


def rubble() -> str:
    """Pieces that fall into a heap: four to a layer, so that they begin apart."""
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
            models.append(box(f"box_{number}", pose, size, mass, "Grey"))
        else:
            radius, length = round(rng.uniform(0.05, 0.15), 2), round(rng.uniform(0.3, 0.8), 2)
            mass = DENSITY * math.pi * radius ** 2 * length
            models.append(cylinder(f"cylinder_{number}", pose, radius, length, mass, "Bricks"))
    return HEAD + "".join(models) + TAIL


def stacks() -> str:
    """Towers of five boxes, spheres and thin cylinders of 1 m and 1 kg."""
    models = []
    for number in range(5):
        z = number + 0.5
        models += [
            box(f"box_{number + 1}", [0, 0, z, 0, 0, 0], [1, 1, 1], 1, "WoodPallet"),
            sphere(f"sphere_{number + 1}", [0, 1.5, z, 0, 0, 0], 0.5, 1, "WoodPallet"),
            sphere(f"sphere_{number + 1}a", [1.5, 1.5, z, 0, 0, 0], 0.5, 1, "WoodPallet"),
            cylinder(f"cylinder_{number + 1}", [0, -1.5, z, 0, 0, 0], 0.1, 1, 1, "WoodPallet")]
    return HEAD + "".join(models) + TAIL


def terrain() -> np.ndarray:
    """(SIDE, SIDE) uint16 grey values: level in the middle, rolling up to the rim."""
    return np.array([[round(65535 * _height(column - SIDE // 2, SIDE // 2 - row) / TALLEST)
                      for column in range(SIDE)] for row in range(SIDE)], np.uint16)


def _height(x: float, y: float) -> float:
    """Of the bowl, m."""
    out = min(1.0, max(0.0, (math.hypot(x, y) - FLAT) / (SIDE / 2)))
    waves = math.sin(x / 7) * math.cos(y / 9)
    return (7.5 + waves) * out * out * (3 - 2 * out)


def _model(name: str, pose: list[float], shape: str, mass: float, look: str,
           moments: list[float]) -> str:
    xx, yy, zz = moments
    return MODEL.format(name=name, pose=_numbers(pose), shape=shape, mass=mass, look=look,
                        xx=xx, yy=yy, zz=zz)


def _numbers(values: list[float]) -> str:
    return " ".join(f"{value:.4g}" for value in values)


def files() -> dict[str, str]:
    """What the script writes: text by name in data/worlds."""
    return {"rubble.world": rubble(), "stacks.world": stacks()}


if __name__ == "__main__":
    for file_name, text in files().items():
        (WORLDS / file_name).write_text(text, encoding="utf-8")
    (DATA / TERRAIN).parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(DATA / TERRAIN), terrain(), [cv2.IMWRITE_PNG_COMPRESSION, 9])
