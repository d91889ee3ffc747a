"""Checks files and packages, each file in a process with limits."""

import itertools
import os
import pickle
import re
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from bullet_sim.errors import did_you_mean
from bullet_sim.formats.xacro.bounds import TooLarge, run_bounded
from bullet_sim_ros.interface import documented
from bullet_sim_ros.package_paths import open_resources
from bullet_sim_ros.plugins import register_plugins
from workspace_needs.check.findings import HINT, WORKS, Finding, problem
from workspace_needs.check.launches import NONE_UNBUILT, LaunchChecker, Unbuilt
from workspace_needs.check.modules import text_of
from workspace_needs.check.packages import has_interpreter, is_python
from workspace_needs.check.sources import holds_python, program_findings, script_findings
from workspace_needs.check.texts import TextChecker

LONGEST = 60.0  # s of processor time for a file; large worlds take 10
MOST_BYTES = 2**31
INCLUDED = re.compile(r"<(?:xacro:)?include\b[^>]*filename=[\"']([^\"']+)[\"']")


class Check:
    """Checks what is in files and packages.

    `arguments`: words NAME:=VALUE for xacro and launch files. `environ`: the variables that a
    launch would have. `unbuilt`: as of LaunchChecker.
    """

    def __init__(self, arguments: list[str], run_commands: bool,
                 environ: Mapping[str, str] = os.environ, unbuilt: Unbuilt = NONE_UNBUILT):
        self._arguments = arguments
        self._environ = environ
        resources = open_resources(environ)
        rows = documented()
        self._texts = TextChecker(rows, resources)
        self._launches = LaunchChecker(rows, self._texts, resources, run_commands, environ, unbuilt)
        self._files = 0  # that were looked at

    def file(self, path: Path, alone: bool = True) -> list[Finding]:
        """Findings about one file, from a process of its own with limits of time and memory.

        `alone`: the user named this file, and not only its package or workspace.
        """
        if self._files == 1:
            register_plugins()  # here, so that not the process of each further file imports them
        self._files += 1
        with tempfile.TemporaryDirectory(prefix="check-") as folder:
            result = Path(folder) / "findings"

            def look() -> int:
                os.environ.update(self._environ)
                tempfile.tempdir = folder  # so that what an ended process leaves goes, too
                result.write_bytes(pickle.dumps(self._looked_at(path, alone)))
                return 0

            try:
                if run_bounded(look, str(path), LONGEST, "checking it", MOST_BYTES) == 0:
                    return pickle.loads(result.read_bytes())  # our own, from the line above
            except TooLarge as error:
                return [problem(str(path), "file", error)]
        return [problem(str(path), "file", "checking it failed, see above")]

    def _looked_at(self, path: Path, alone: bool) -> list[Finding]:
        if path.suffix == ".launch":
            return self._launches.launch_file(path, self._arguments, alone)
        if path.suffix == ".world":
            return self._texts.world_file(path)
        if path.suffix == ".yaml":
            return self._launches.yaml_file(path)
        python = is_python(path) or holds_python(path)
        if python or has_interpreter(path):
            what = "first line, syntax and modules" if python else "first line"
            found = list(script_findings(path))
            works = all(each.status == HINT for each in found)
            return [*found, *([Finding(str(path), what, WORKS)] if works else [])]
        values = dict(word.split(":=", 1) for word in self._arguments if ":=" in word)
        if path.suffix == ".sdf" and "<world" in text_of(path):
            return self._texts.world_file(path)
        return self._texts.model_file(path, values, shown_only=not alone)

    def launch_of_package(self, folder: Path, name: str) -> list[Finding]:
        """Findings about the launch file (or world, robot ...) of that name below a folder."""
        kind = Path(name).suffix or ".launch"
        there = sorted(folder.rglob(f"*{kind}"))
        found = [path for path in there if str(path).endswith(f"/{name}")]
        if not found:
            names = sorted(path.name for path in folder.rglob("*.launch"))
            return [problem(str(folder), f"launch file {name}",
                            f"not there{did_you_mean(name, names, 0.75)}; there are: "
                            f"{', '.join(names) or 'none'}")]
        return self.file(found[0])

    def package(self, folder: Path, where: str = "") -> list[Finding]:
        """Findings about a package's programs and all of its `files_of`."""
        return [*program_findings(folder, time.monotonic() + LONGEST, where),
                *(finding for path in files_of(folder)
                  for finding in self.file(path, alone=False))]


def files_of(folder: Path) -> list[Path]:
    """The robots, worlds, launch files and YAML of a package.

    A xacro file is a robot if it has links and no other of the package includes it.
    """
    macros = {path: text_of(path) for path in sorted(folder.rglob("*.xacro"))
              if path.is_file()}
    included = {Path(name).name for text in macros.values() for name in INCLUDED.findall(text)}
    robots = [path for path, text in macros.items()
              if path.name not in included and "<link" in text]
    urdf, *others = (sorted(folder.rglob(pattern)) for pattern in
                     ("*.urdf", "*.world", "model.sdf", "*.launch", "*.yaml"))
    return [path for path in itertools.chain(urdf, robots, *others) if path.is_file()]
