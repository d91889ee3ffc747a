"""Checks robot and world texts: reads and spawns them as the simulator would, and listens."""

from __future__ import annotations

import logging
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from xml.etree.ElementTree import ParseError, fromstring

from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats import Resources, load_light, load_model, load_world
from bullet_sim.formats.xacro_files import expand_file
from bullet_sim.formats.xacro_limits import run_bounded
from bullet_sim.world import World
from bullet_sim_ros.check.elements import Lookup, problem
from bullet_sim_ros.check.findings import WORKS, Finding
from bullet_sim_ros.interface import Row

STEPS = 10  # enough for what only shows when time passes


class _Listener(logging.Handler):
    def __init__(self):
        super().__init__(logging.WARNING)
        self.lines: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.lines.append(record.getMessage())


@contextmanager
def _heard() -> Iterator[list[str]]:
    """What the core warns of meanwhile; it does not reach the terminal."""
    core, listener = logging.getLogger("bullet_sim"), _Listener()
    propagated, core.propagate = core.propagate, False
    core.addHandler(listener)
    try:
        yield listener.lines
    finally:
        core.removeHandler(listener)
        core.propagate = propagated


class TextChecker:
    """Robots and worlds, with the resources of this environment."""

    def __init__(self, rows: dict[str, Row], resources: Resources):
        self._rows = rows
        self._resources = resources

    def model_file(self, path: Path, arguments: dict[str, str]) -> list[Finding]:
        """A .urdf, .xacro or .sdf file; xacro is expanded first."""
        where = str(path)
        try:
            if path.suffix == ".xacro":
                return self.model_text(self._expanded(path, arguments), where)
            return self.model_text(path.read_text(encoding="utf-8-sig"), where)
        except (SimulationError, OSError, UnicodeDecodeError) as error:
            return [problem(where, "robot", error)]

    def _expanded(self, path: Path, arguments: dict[str, str]) -> str:
        """The URDF of a xacro file; its expressions may want any time or memory."""
        with tempfile.TemporaryDirectory(prefix="check-") as folder:
            result = Path(folder) / "result"

            def expand_into_file() -> int:
                try:
                    text = expand_file(path, arguments, find_package=self._find_package).text
                except SimulationError as error:
                    result.write_text(str(error), encoding="utf-8")
                    return 1
                result.write_text(text, encoding="utf-8")
                return 0

            with _heard():
                code = run_bounded(expand_into_file, str(path))
            said = result.read_text(encoding="utf-8") if result.exists() else "it failed"
        if code:
            raise FormatError(said)
        return said

    def _find_package(self, name: str) -> str:
        return str(self._resources.package_folder(name))

    def model_text(self, text: str, where: str) -> list[Finding]:
        """A robot or model, spawned into an empty world."""
        with _heard() as lines:
            try:
                if load_light(text, self._resources) is not None:
                    return [Finding(where, "light", WORKS)]
                description = load_model(text, self._resources, None)
                world = World()
                try:
                    world.spawn(description)
                    world.step(STEPS)
                finally:
                    world.close()
            except SimulationError as error:
                return [problem(where, "robot", error)]
        links = f"{len(description.links)} links, {len(description.joints)} joints"
        return [Finding(where, f"model {description.name} ({links})", WORKS),
                *self._details(text, where), *(problem(where, "it warns", said) for said in lines)]

    def world_file(self, path: Path) -> list[Finding]:
        """A world with all that it includes."""
        where = str(path)
        with _heard() as lines:
            try:
                world = World(load_world(path, self._resources))
                try:
                    world.step(STEPS)
                finally:
                    world.close()
            except (SimulationError, OSError) as error:
                return [problem(where, "world", error)]
        name = f"world {world.description.name} ({len(world.description.models)} models)"
        text = path.read_text(encoding="utf-8-sig", errors="replace")
        return [Finding(where, name, WORKS), *self._details(text, where),
                *(problem(where, "it warns", said) for said in lines)]

    def _details(self, text: str, where: str) -> list[Finding]:
        try:
            return list(Lookup(self._rows, where).findings(fromstring(text)))
        except ParseError:
            return []  # the reader is more patient than the strict parser
