"""Mesh files: STL, OBJ, COLLADA."""

from __future__ import annotations

import struct
from pathlib import Path

import scipy.spatial  # noqa: F401 (in memory before that is bounded: levels() takes it)
from mutating import BINARY, TEXT, XML_TEXT, spoilt
from target import Target, found

from bullet_sim.description import Mesh
from bullet_sim.errors import SimulationError
from bullet_sim.meshes.detail import levels
from bullet_sim.meshes.loading import collision_mesh, load_mesh

TEXT_STL = (b"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
            b"endloop\nendfacet\nendsolid s\n")
LYING_STL = b"\0" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 50
OBJ = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\n"


def read_mesh(path: Path) -> None:
    """As it is drawn, near and far away, and as it collides."""
    for part in load_mesh(Mesh(str(path))):
        levels(part, fewest=1)
    collision_mesh(Mesh(str(path)))


TARGETS = (
    Target("stl", "input.stl", spoilt([*found("**/*.stl", largest=20_000), TEXT_STL, LYING_STL],
                                      BINARY + TEXT), read_mesh, (SimulationError,)),
    Target("obj", "input.obj", spoilt([*found("**/*.obj", largest=20_000), OBJ], TEXT),
           read_mesh, (SimulationError,), tuple(found("**/meshes/*.mtl"))),
    Target("collada", "input.dae", spoilt(found("**/*.dae"), XML_TEXT + TEXT), read_mesh,
           (SimulationError,)),
)
