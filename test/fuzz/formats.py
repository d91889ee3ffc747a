"""Robots, worlds, materials and meshes: URDF, SDF, xacro, OGRE; STL, OBJ, COLLADA."""

from __future__ import annotations

import struct
from functools import cache
from pathlib import Path

import scipy.spatial  # noqa: F401 (in memory before that is bounded: levels() takes it)
from mutating import BINARY, TEXT, XML_TEXT, spoilt
from target import ROOT, Target, found

from bullet_sim.description import Mesh, WorldDescription
from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.ogre import parse_script
from bullet_sim.formats.resources import DATA_FOLDER, Resources
from bullet_sim.formats.sdf.material import find_material
from bullet_sim.formats.source import Source
from bullet_sim.formats.xacro.bounds import run_bounded
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xml_text import decoded, read_bytes
from bullet_sim.meshes.detail import levels
from bullet_sim.meshes.loading import collision_mesh, load_mesh
from bullet_sim.world import World

STEPS = 3
REFUSED = 2  # exit code of xacro


@cache
def _package(name: str) -> str:
    for path in (ROOT / "src").glob(f"**/{name}/package.xml"):
        return str(path.parent)
    raise LookupError(f"no package {name}")


RESOURCES = Resources([DATA_FOLDER / "models"], [DATA_FOLDER], _package)


def spawn_model(path: Path) -> None:
    """As spawn_model does it, and some steps."""
    world = World(WorldDescription())
    try:
        world.spawn(load_model(decoded(read_bytes(path)), RESOURCES))
        world.step(STEPS)
    finally:
        world.close()


def start_world(path: Path) -> None:
    """As a simulator that starts with the file, and some steps."""
    world = World(load_world(path, RESOURCES))
    try:
        world.step(STEPS)
    finally:
        world.close()


def expand_xacro(path: Path) -> None:
    """As the command xacro, in the process that bounds it: by its own 3.5 s, not by those here."""
    def work() -> int:
        try:
            expand(path, {}, _package)
        except (SimulationError, OSError) as error:
            return REFUSED if "\n" not in str(error) else 1
        return 0

    if run_bounded(work, str(path)) not in (0, REFUSED):
        raise RuntimeError("another error than its own, or one of more than a line")


def read_script(path: Path) -> None:
    """Each material that a model could name."""
    source = Source(RESOURCES)
    names = list(parse_script(path.read_text(encoding="utf-8", errors="replace")))
    for name in names or ["none"]:
        find_material(name, [str(path)], source, "fuzz")


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
    Target("urdf", "robot.urdf", spoilt(found("**/urdf/*.urdf", "**/styles/*.urdf"), XML_TEXT),
           spawn_model, (SimulationError,)),
    Target("sdf", "model.sdf",
           spoilt(found("**/turtlebot3_*/model.sdf", "**/styles/**/model.sdf", "**/person_*/*.sdf",
                        largest=20_000), XML_TEXT), spawn_model, (SimulationError,)),
    Target("world", "input.world",
           spoilt(found("**/worlds/*.world", "**/styles/*.world", largest=20_000), XML_TEXT),
           start_world, (SimulationError,)),
    Target("xacro", "robot.urdf.xacro",
           spoilt(found("**/urdf/*.xacro", "**/controllers/*.xacro", "**/styles/*.xacro"),
                  XML_TEXT), expand_xacro, (SimulationError,)),
    Target("ogre", "input.material", spoilt(found("**/*.material"), TEXT), read_script,
           (SimulationError,)),
    Target("stl", "input.stl", spoilt([*found("**/*.stl", largest=20_000), TEXT_STL, LYING_STL],
                                      BINARY + TEXT), read_mesh, (SimulationError,)),
    Target("obj", "input.obj", spoilt([*found("**/*.obj", largest=20_000), OBJ], TEXT),
           read_mesh, (SimulationError,), tuple(found("**/meshes/*.mtl"))),
    Target("collada", "input.dae", spoilt(found("**/*.dae"), XML_TEXT + TEXT), read_mesh,
           (SimulationError,)),
)
