"""A workspace's packages: what package.xml, launch files and includes ask for."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import yaml
from catkin_pkg.package import InvalidPackage, parse_package
from catkin_pkg.packages import find_package_paths

INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"\n]+)[>\"]", re.MULTILINE)
NODE = re.compile(r"<node\b[^>]*\bpkg=[\"']([\w-]+)[\"']")
FOUND = re.compile(r"\$\(find\s+([\w-]+)\s*\)")
CATKIN_PACKAGE = re.compile(r"^\s*catkin_package\s*\(", re.MULTILINE)
SOURCES = (".c", ".cc", ".cpp", ".cxx", ".h", ".hh", ".hpp")
OUR_ADDRESS = "courses@example.org"
MARKER = "CATKIN_IGNORE"
MARK = ("made by the build: the driving courses' own package of this name is used; remove this "
        "file to build this one\n")
KINDS = ("build", "buildtool", "build_export", "exec", "buildtool_export", "test")
LARGEST = 1 << 20  # bytes of a file that is searched


class WorkspaceError(ValueError):
    """There is no such workspace, or nothing in it can be built; the message says what to do."""


@dataclass(frozen=True)
class Asked:
    """A dependency of a package, and the file that declares it."""

    key: str
    where: str


@dataclass
class Package:
    """One package of the workspace."""

    name: str
    folder: Path
    asked: list[Asked] = field(default_factory=list)
    built_with: set[str] = field(default_factory=set)  # of package.xml, as run_with
    run_with: set[str] = field(default_factory=set)
    files: list[Path] = field(default_factory=list)
    includes: list[tuple[str, str]] = field(default_factory=list)  # header, file
    problem: str = ""  # why its package.xml cannot be read
    unfit: dict[str, str] = field(default_factory=dict)  # what no build tool can handle: why
    is_ours: bool = False  # of this repository: setup installs its dependencies


def source_folder(path: Path) -> Path:
    """The src/ of a workspace, or a folder of packages itself; WorkspaceError if neither."""
    path = path.expanduser()
    if not path.is_dir():
        raise WorkspaceError(f"{path}: there is no such folder; give the workspace's, such as "
                             "~/catkin_ws")
    for folder in (path / "src", path):
        if folder.is_dir() and (find_package_paths(str(folder)) or _hidden(folder)
                                or list(_without_manifest(folder))):
            return folder.resolve()
    if (path / "src").is_dir():
        raise WorkspaceError(f"{path}/src: there is no package in it; clone one into it first")
    raise WorkspaceError(f"{path}: this is not a workspace, it has no src/ with packages; give the "
                         "folder above src/, such as ~/catkin_ws")


def saved_options(source: Path) -> list[str]:
    """What `catkin config --cmake-args` saved for the workspace of this src/; mostly nothing."""
    profiles = source.parent / ".catkin_tools" / "profiles"
    try:
        active = _yaml(profiles / "profiles.yaml").get("active") or "default"
        return [str(word) for word in _yaml(profiles / active / "config.yaml")["cmake_args"]]
    except (OSError, KeyError, TypeError, AttributeError, ValueError, yaml.YAMLError):
        return []  # none saved, or a file that catkin itself will name


def _yaml(path: Path) -> dict:
    return yaml.safe_load(path.read_text("utf-8")) if path.exists() else {}


def read_workspace(source: Path) -> list[Package]:
    """All packages below `source`, by name; WorkspaceError if no build tool can build any."""
    hidden = _hidden(source)
    packages = [_read(source / path)
                for path in sorted({*find_package_paths(str(source)), *hidden})]
    home = next((each.folder.parent for each in packages if each.name == "workspace_needs"), None)
    for package in packages:  # a copy of a lesson in a user's own workspace is not ours
        package.is_ours = package.is_ours and home in package.folder.parents
    by_name: dict[str, Path] = {}
    for package in packages:
        if package.problem:
            raise WorkspaceError(f"{package.folder}/package.xml: {package.problem}; mend it first, "
                                 "no package is built before")
        if package.folder in {source / path for path in hidden}:
            continue  # its namesake is ours
        other = by_name.setdefault(package.name, package.folder)
        if other != package.folder:
            raise WorkspaceError(f"two packages are called {package.name}: {other} and "
                                 f"{package.folder}; remove or rename one")
    packages += [Package(path.name, path, unfit={
        "package.xml": "there is none; catkin_create_pkg makes packages with one"})
        for path in _without_manifest(source) if path.name not in by_name]
    return sorted(packages, key=lambda package: package.name)


def hide(folder: Path) -> None:
    """Keeps rospack and the build tools from finding a package; OSError if it cannot be written."""
    if not (folder / MARKER).exists():
        (folder / MARKER).write_text(MARK, "utf-8")


def _hidden(source: Path) -> list[str]:
    """The packages that `hide` was called for, by their paths below `source`."""
    return [str(path.parent.relative_to(source)) for path in source.rglob(MARKER)
            if (path.parent / "package.xml").is_file() and _text(path) == MARK]


def _without_manifest(source: Path) -> Iterator[Path]:
    """The folders that were to be packages, to go by CMakeLists.txt, but no tool takes for any."""
    for place, below, names in os.walk(source):
        if {"package.xml", MARKER} & set(names):
            below.clear()
        elif place != str(source) and "CMakeLists.txt" in names and CATKIN_PACKAGE.search(
                _text(Path(place, "CMakeLists.txt"))):
            yield Path(place)
            below.clear()


def _read(folder: Path) -> Package:
    try:
        manifest = parse_package(str(folder), warnings=[])
        manifest.evaluate_conditions({"ROS_VERSION": "1", "ROS_PYTHON_VERSION": "3",
                                      "ROS_DISTRO": os.environ.get("ROS_DISTRO", "noetic")})
        package = Package(manifest.name, folder, unfit=_unfit(manifest, folder))
    except (InvalidPackage, OSError, ValueError) as error:
        said = getattr(error, "msg", None) or str(error)
        if isinstance(error, UnicodeDecodeError):
            said = "it is not UTF-8; save it as UTF-8"
        return Package(folder.name, folder, problem=" ".join(str(said).split()))
    package.is_ours = any(person.email == OUR_ADDRESS for person in manifest.maintainers)
    package.asked += [Asked(key, "package.xml") for key in _declared(manifest)]
    package.built_with.update(_declared(manifest, "build", "buildtool", "test"))
    package.run_with.update(_declared(manifest, "build_export", "buildtool_export", "exec"))
    package.files = list(_files(folder))
    for path in package.files:
        shown = str(path.relative_to(folder))
        if path.suffix in SOURCES:
            package.includes += [(header, shown) for header in INCLUDE.findall(_text(path))]
        elif ".launch" in path.suffixes:
            text = _text(path)
            package.asked += [Asked(key, shown) for key in
                              dict.fromkeys(NODE.findall(text) + FOUND.findall(text))]
    return package


def _unfit(manifest, folder: Path) -> dict[str, str]:
    kind = manifest.get_build_type()
    if kind.startswith("ament"):
        return {kind: "this is a package of ROS 2; clone its branch for ROS 1, as with "
                      "git clone -b noetic"}
    has_file = (folder / "CMakeLists.txt").is_file()
    if kind == "catkin" and not has_file and not manifest.is_metapackage():
        return {"CMakeLists.txt": "there is none; catkin_create_pkg makes packages with one"}
    return {}


def _declared(manifest, *kinds: str) -> list[str]:
    return list(dict.fromkeys(
        depend.name for kind in kinds or KINDS for depend in getattr(manifest, f"{kind}_depends")
        if depend.evaluated_condition is not False))


def _files(folder: Path) -> Iterator[Path]:
    for place, below, names in os.walk(folder):
        below[:] = sorted(name for name in below if not name.startswith("."))
        # No pipe or device: to read one may take for ever.
        yield from (path for name in sorted(names) if (path := Path(place) / name).is_file())


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return file.read(LARGEST).decode("utf-8", "replace")
    except OSError:
        return ""
