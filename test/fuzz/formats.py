"""Robots, worlds and materials: URDF, SDF, xacro, OGRE."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from mutating import TEXT, XML_TEXT, spoilt
from target import ROOT, Target, found

from bullet_sim.description import WorldDescription
from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.ogre import parse_script
from bullet_sim.formats.resources import DATA_FOLDER, Resources
from bullet_sim.formats.sdf.material import find_material
from bullet_sim.formats.source import Source
from bullet_sim.formats.xacro.bounds import run_bounded
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xml_text import decoded, read_bytes
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
)
