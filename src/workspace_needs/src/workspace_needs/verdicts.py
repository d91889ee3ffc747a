"""Package by package: builds, needs Debian packages, or is left out and why."""

from __future__ import annotations

import contextlib
import io
import shlex
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import rospkg
from catkin_pkg.topological_order import topological_order

from workspace_needs.configuring import Configured, configure
from workspace_needs.tables import DEBIAN, OURS, Answer, Tables
from workspace_needs.tables import tables as all_tables
from workspace_needs.workspace import Package, read_workspace, saved_options

INCLUDE_FOLDERS = ("/usr/include", "/usr/local/include")


@dataclass
class Verdict:
    """Whether one package can be built, and what it lacks."""

    name: str
    folder: Path
    missing: dict[str, str] = field(default_factory=dict)  # Debian package: the key that needs it
    waits: str = ""  # of `missing`, the one for want of which CMake ends with an error now
    stops: dict[str, str] = field(default_factory=dict)  # obstacle to building it: reason
    lacks: dict[str, str] = field(default_factory=dict)  # missing, but not needed to build: reason
    left_out: dict[str, str] = field(default_factory=dict)  # target or source file: reason
    uncompiled: dict[str, str] = field(default_factory=dict)  # a target's source file: reason
    clashes: dict[str, str] = field(default_factory=dict)  # stops for catkin_make alone: reason
    programs: tuple[str, ...] | None = None  # what rosrun starts once it is built; None: unknown
    hides_ours: bool = False  # it is left out because our package of its name must be found

    @property
    def builds(self) -> bool:
        """Whether it builds once `missing` is installed."""
        return not self.stops


def judge(source: Path, tables: Tables | None = None, words: Iterable[str] = (),
          now: bool = False) -> list[Verdict]:
    """A verdict for each package below `source` that does not belong to this repository.

    `words`: the -D options with which the workspace is built, behind those that `catkin config`
    saved. `now`: what is not installed stops a package whose CMake ends with an error without it.
    WorkspaceError if no build tool can build any.
    """
    tables = tables or all_tables()
    packages = [package for package in read_workspace(source) if not package.is_ours]
    hidden = {package.name: why for package in packages
              if (why := tables.why_ours_stays(package.name))}
    configured = configure((each for each in packages if each.name not in hidden),
                           [*saved_options(source), *words])
    judgement = _Judgement(packages, configured, tables, _order(source))
    verdicts = [Verdict(package.name, package.folder, hides_ours=True,
                        stops={"ours is used": hidden[package.name]})
                if package.name in hidden else judgement.of(package) for package in packages]
    for verdict in verdicts if now else ():
        if verdict.waits:
            verdict.stops[verdict.waits] = (
                "it is not installed; type: rosrun workspace_needs deps "
                f"{shlex.quote(str(source.resolve().parent))}")
    _pass_on(configured, verdicts)
    _note_clashes(configured, verdicts)
    return verdicts


class _Judgement:
    """What is known of all packages of a workspace together."""

    def __init__(self, packages: list[Package], configured: dict[str, Configured],
                 tables: Tables, order: list[str]):
        self._tables, self._order = tables, order
        self._configured = configured
        self._names = {package.name for package in packages}
        self._known = self._names | set(rospkg.RosPack().list())
        keys = {asked.key for package in packages for asked in package.asked}
        keys |= {name for result in configured.values() for name in result.absent}
        keys |= {header.partition("/")[0] for package in packages
                 for header, _ in package.includes if "/" in header}
        self._answers = {key: self._answer(key) for key in keys}
        self._installed = installed_packages(
            name for answer in self._answers.values() for name in answer.packages)

    def _answer(self, key: str) -> Answer:
        return Answer(OURS) if key in self._names else self._tables.answer_cmake(key, self._names)

    def of(self, package: Package) -> Verdict:
        """The verdict on one package, not yet on those that it depends on."""
        verdict = Verdict(package.name, package.folder, stops=dict(package.unfit))
        if not verdict.builds:
            return verdict
        result = self._configured.get(package.name)
        if result and result.error:
            self._blame(verdict, result, package)
        for asked in package.asked:
            if not self._missing(verdict, asked.key) and asked.key not in self._known | {
                    *verdict.stops} and self._answers[asked.key].kind not in (OURS, DEBIAN):
                verdict.lacks.setdefault(
                    asked.key, f"{self._answers[asked.key].why} ({asked.where} asks for it)")
        self._look_at_includes(verdict, package, _compiled(package, result))
        if result and not result.error:
            verdict.left_out = {f"target {target}": why for target, why in result.left_out}
            verdict.programs = result.programs
        return verdict

    def _missing(self, verdict: Verdict, key: str) -> bool:
        """Whether Debian packages for a key are not installed; they are noted."""
        missing = {name: key for name in self._answers[key].packages
                   if name not in self._installed}
        verdict.missing.update(missing)
        return bool(missing)

    def _blame(self, verdict: Verdict, result: Configured, package: Package) -> None:
        """Notes why CMake ended with an error: what is absent, else the error itself."""
        explained = False
        for name in result.absent:
            if self._is_later(name, verdict.name):
                verdict.stops[name] = ("it is configured later, because package.xml does not name "
                                       f"it; add <depend>{name}</depend> there")
                continue
            if name in self._names and name not in package.built_with:
                verdict.lacks[name] = (
                    "package.xml does not name it: catkin_make comes to it earlier only by its "
                    f"name, catkin build may not; add <depend>{name}</depend> there")
            kind = self._answers[name].kind
            if self._missing(verdict, name):
                verdict.waits = next(package for package, key in verdict.missing.items()
                                     if key == name)
                explained = True
            elif kind == OURS or name == "gazebo":
                explained = True  # to be built first
            elif kind != DEBIAN:  # what is installed is there in another version, say
                verdict.stops[name] = f"{self._answers[name].why} (CMakeLists.txt asks for it)"
        if not explained and verdict.builds:
            place, _, said = result.error.partition(": ")
            verdict.stops[place if said else "CMake"] = said or place

    def _is_later(self, name: str, other: str) -> bool:
        """Whether the build tools come to a package of the workspace after the other one."""
        return {name, other} <= set(self._order) and (
            self._order.index(name) > self._order.index(other))

    def _look_at_includes(self, verdict: Verdict, package: Package, compiled: set[str]) -> None:
        for header, file in package.includes:
            folder = header.partition("/")[0]
            if folder == header or any(Path(place, header).exists() for place in INCLUDE_FOLDERS):
                continue
            if any(str(path).endswith(f"/{header}") for path in package.files):
                continue
            if absence := self._tables.missing_header(header):
                verdict.left_out.setdefault(file, f"it includes <{header}>: {absence.why}")
                continue
            answer = self._answers[folder]
            if (file in compiled and folder not in self._known
                    and not self._missing(verdict, folder)
                    and folder.endswith("_msgs") and answer.kind not in (OURS, DEBIAN)):
                verdict.uncompiled.setdefault(
                    file, f"the header <{header}> is not here: {answer.why}")


def _compiled(package: Package, result: Configured | None) -> set[str]:
    """The sources of a package's targets, and its headers that these include."""
    found = set(result.sources) if result else set()
    files = [str(path.relative_to(package.folder)) for path in package.files]
    reached = True
    while reached:
        headers = {header for header, file in package.includes if file in found}
        reached = {file for file in files if file not in found
                   and any(f"/{file}".endswith(f"/{header}") for header in headers)}
        found |= reached
    return found


def _order(source: Path) -> list[str]:
    """The packages below `source` in the build tools' order, up to a circle if there is one."""
    with contextlib.redirect_stderr(io.StringIO()):  # the build says it, too
        return [package.name for path, package in topological_order(str(source))
                if path is not None]


def _pass_on(configured: dict[str, Configured], verdicts: list[Verdict]) -> None:
    """Leaves out packages whose CMakeLists.txt requires one that is left out."""
    by_name = {verdict.name: verdict for verdict in verdicts}
    changed = True
    while changed:
        changed = False
        for name, result in configured.items():
            for other in result.absent:
                needed = by_name.get(other)
                if (needed and not needed.builds and not needed.hides_ours
                        and by_name[name].builds):
                    by_name[name].stops[other] = "it is left out itself"
                    changed = True


def _note_clashes(configured: dict[str, Configured], verdicts: list[Verdict]) -> None:
    """Of the packages that define a target of one name, the first by name keeps it."""
    owners: dict[str, str] = {}
    for verdict in verdicts:
        result = configured.get(verdict.name)
        for target in result.targets if result and verdict.builds else ():
            if owners.setdefault(target, verdict.name) != verdict.name:
                verdict.clashes[f"target {target}"] = (
                    f"{owners[target]} has one of that name, too; rename one, or build with "
                    "catkin_make_isolated or catkin build")


def installed_packages(names: Iterable[str]) -> set[str]:
    """Those of Debian's packages `names` that are installed."""
    wanted = sorted(set(names))
    if not wanted:
        return set()
    listed = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", *wanted],
        capture_output=True, text=True, check=False).stdout
    return {line.split()[0] for line in listed.splitlines() if line.endswith(" installed")}
