"""Package by package: builds, needs Debian packages, or is left out and why."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import rospkg

from workspace_needs.tables import ABSENT, DEBIAN, OURS, UNKNOWN, Answer, Tables
from workspace_needs.workspace import Asked, Package, read_workspace

# Names in find_package that come with CMake or catkin, or that have a Find script.
WITH_CMAKE = {"catkin", "Threads", "PkgConfig", "PythonInterp", "PythonLibs", "Python", "Python3",
              "Doxygen", "OpenMP", "Java", "Git", "Matlab", "CUDA"}


@dataclass
class Verdict:
    """Whether one package can be built, and what it lacks."""

    name: str
    folder: Path
    missing: dict[str, str] = field(default_factory=dict)  # Debian package: the key that needs it
    stops: dict[str, str] = field(default_factory=dict)  # obstacle to building it: reason
    lacks: dict[str, str] = field(default_factory=dict)  # missing, but not needed to build: reason
    left_out: dict[str, str] = field(default_factory=dict)  # source file not compiled: reason
    unsure: list[str] = field(default_factory=list)  # names in no table, which CMake may find

    @property
    def builds(self) -> bool:
        """Whether it builds once `missing` is installed."""
        return not self.stops


def judge(source: Path, tables: Tables | None = None) -> list[Verdict]:
    """A verdict for each package below `source` that does not belong to this repository.

    WorkspaceError if no build tool can build any.
    """
    tables = tables or Tables()
    packages = [package for package in read_workspace(source) if not package.is_ours]
    names = {package.name for package in packages}
    known = names | set(rospkg.RosPack().list())
    answers = {asked.key: _answer(asked.key, tables, names)
               for package in packages for asked in package.asked}
    installed = installed_packages(name for answer in answers.values() for name in answer.packages)
    verdicts = [_verdict(package, answers, installed, known, tables) for package in packages]
    _pass_on(packages, verdicts)
    return verdicts


def _answer(key: str, tables: Tables, names: set[str]) -> Answer:
    if key in names or key in WITH_CMAKE:
        return Answer(OURS)
    answer = tables.answer(key)
    if answer.kind in (UNKNOWN, ABSENT) and key in tables.cmake_names:
        return tables.answer(tables.cmake_names[key])
    return answer


def _verdict(package: Package, answers: dict[str, Answer], installed: set[str], known: set[str],
             tables: Tables) -> Verdict:
    verdict = Verdict(package.name, package.folder)
    if package.unfit:
        verdict.stops = dict(package.unfit)
        return verdict
    for asked in package.asked:
        answer = answers[asked.key]
        if answer.kind == DEBIAN:
            verdict.missing.update(
                {name: asked.key for name in answer.packages if name not in installed})
        elif asked.of_cmake and answer.kind == UNKNOWN:
            if not _has_module(asked.key, package.folder):
                verdict.unsure.append(asked.key)
        elif not (answer.kind == OURS or asked.key in known or _is_gazebo(asked)):
            said = f"{answer.why} ({asked.where} asks for it)"
            place = verdict.stops if asked.stops else verdict.lacks
            place.setdefault(asked.key, said)
    for header, file in package.includes:
        absence = tables.missing_header(header)
        if absence and not any(package.folder.glob(f"**/{header}")):
            verdict.left_out.setdefault(file, f"it includes <{header}>: {absence.why}")
    for key in verdict.stops:
        verdict.lacks.pop(key, None)
    return verdict


def _is_gazebo(asked: Asked) -> bool:
    """Whether it is find_package(gazebo), which we provide, without headers."""
    return asked.of_cmake and asked.key == "gazebo"


def _has_module(name: str, folder: Path) -> bool:
    """Whether CMake or the package itself has a Find module for `name`."""
    module = f"Find{name}.cmake"
    return any(Path("/usr/share").glob(f"cmake-*/Modules/{module}")) or any(folder.rglob(module))


def _pass_on(packages: list[Package], verdicts: list[Verdict]) -> None:
    """Leaves out packages that depend on one that is left out."""
    by_name = {verdict.name: verdict for verdict in verdicts}
    changed = True
    while changed:
        changed = False
        for package in packages:
            for asked in package.asked:
                other = by_name.get(asked.key)
                if asked.stops and other and other.stops and by_name[package.name].builds:
                    by_name[package.name].stops[asked.key] = "it is left out itself"
                    changed = True


def installed_packages(names: Iterable[str]) -> set[str]:
    """Those of Debian's packages `names` that are installed."""
    wanted = sorted(set(names))
    if not wanted:
        return set()
    listed = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", *wanted],
        capture_output=True, text=True, check=False).stdout
    return {line.split()[0] for line in listed.splitlines() if line.endswith(" installed")}
