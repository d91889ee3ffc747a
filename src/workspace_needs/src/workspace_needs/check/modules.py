"""Which Python modules are here, seen without importing any, and why one is not."""

import itertools
import os
import pkgutil
import re
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path

from bullet_sim.errors import did_you_mean
from workspace_needs.tables import ABSENT, DEBIAN, OURS, tables

NAME = re.compile(r"<name>\s*([\w-]+)\s*</name>")
RELAY = re.compile(r"__extended_path = '([^']*)'")  # of catkin, which builds no copies of modules
FINDS_ITSELF = re.compile(r"sys\.modules|__path__")  # a package whose modules are anywhere
GENERATED = re.compile(r"(?:from \._\w+ import \*\s*)+")  # the __init__.py of messages
ENDINGS = {"msg": ("",), "srv": ("", "Request", "Response")}  # of classes made of a file
SOURCES = (".py", ".so", ".c", ".cc", ".cpp", ".cxx", ".pyx", ".i", ".proto")  # of modules
BUILT = re.compile(r"(?:add_library|add_module|swig_add_\w+)\s*\(\s*([\w-]+)", re.IGNORECASE)
ALIKE = 0.75
OF_WORKSPACES = ("devel", "build", ".catkin_workspace", ".catkin_tools")  # beside src/
Source = tuple[Path, bool]  # a folder with modules, and whether those below it are looked through


def why_no_import(module: str, name: str, path: Path, source: Source) -> str:
    """Why the script at `path` cannot `import module`, or `from module import name` if given.

    "" if it can or nobody knows. `source`: of its package.
    """
    first = module.partition(".")[0]
    own = (_names_below(path.parent, False), _names_below(*source))
    if any(first in names for names in own):
        return ""  # perhaps made by a build
    return _why_not_here(module, name, own)


@cache
def _why_not_here(module: str, name: str, own: tuple[frozenset[str], ...]) -> str:
    first = module.partition(".")[0]
    if first in sys.stdlib_module_names or first in sys.modules or find_spec(first):
        if why := _why_no_submodule(module):
            return f"module {module} is not here: {why}"
        return _why_no_message(module, name)
    answer = tables().known(first)
    if answer and answer.kind == OURS:
        return ""
    return f"module {first} is not here: {_why_no_module(first, own)}"


def _why_no_module(name: str, own: Iterable[Iterable[str]]) -> str:
    if new := tables().renamed_modules.get(name):
        return f"Python 3 calls it {new}"
    near = [each for each in sorted(_all_modules().union(*own)) if is_slip(name, each)]
    same = [each for each in near if each.lower() == name.lower()]
    package = tables().module_packages.get(name, f"python3-{name.lower().replace('_', '-')}")
    answer = tables().known(package)
    if answer and answer.kind == DEBIAN and not same:
        return f"sudo apt-get install {package}"
    if meant := same or near:
        return f"no module has that name; is {meant[0]} meant?"
    answer = tables().known(name)
    if answer and answer.kind == ABSENT:
        return answer.why
    return f"Debian has no {package}; put what brings it beside the script or into src/"


@cache
def _all_modules() -> frozenset[str]:
    return sys.stdlib_module_names | {module.name for module in pkgutil.iter_modules()}


def is_slip(typed: str, name: str) -> bool:
    """Whether `typed` is `name` with one slip: in a letter of long names, or in capitals.

    Other names that are as near are other people's modules (cupy and copy, pickle5 and pickle).
    """
    one, other = typed.lower(), name.lower()
    if one == other:
        return True
    same = next(at for at in range(len(one) + 1) if one[at:at + 1] != other[at:at + 1])
    if not same or re.findall(r"\d", one) != re.findall(r"\d", other):
        return False
    one, other = one[same:], other[same:]
    return (len(typed) >= 4 and one[1:] == other) or (len(typed) >= 5 and (
        other[1:] in (one, one[1:]) or (one[:2] == other[1::-1] and one[2:] == other[2:])))


def _why_no_submodule(name: str) -> str:
    parent, *parts = name.split(".")
    for part in parts:
        places = _places(parent)
        if not places:  # a module that makes others, say
            return ""
        there = [each.name for each in pkgutil.iter_modules(places)]
        if part not in (*there, "__init__") and not any(os.path.isdir(os.path.join(each, part))
                                         for each in places):
            if any("sys.meta_path" in text_of(file)  # it makes modules of its own
                   for each in places for file in Path(each).glob("*.py")):
                return ""
            return f"{parent} has no module {part}{did_you_mean(part, there, ALIKE)}"
        parent += f".{part}"
    return ""


@cache
def _places(package: str) -> list[str]:
    """The folders of a package's modules; none if that is known only once it is imported."""
    parent, _, name = package.rpartition(".")
    if parent:
        folders = [os.path.join(place, name) for place in _places(parent)]
    else:
        spec = PathFinder.find_spec(name)
        folders = list((spec and spec.submodule_search_locations) or [])
    init = next((path for folder in folders if (path := Path(folder, "__init__.py")).is_file()),
                None)
    if init is None:  # a namespace, or in a zip file
        return []
    text = text_of(init)
    if relay := RELAY.search(text):
        return [os.path.join(place, package) for place in (*relay[1].split(";"), *sys.path)]
    return [] if FINDS_ITSELF.search(text) else folders


def _why_no_message(module: str, name: str) -> str:
    package, _, kind = module.partition(".")
    if kind not in ENDINGS or name.startswith("_") or name in ("", "*"):
        return ""
    known = _messages(package, kind)
    if not known or name in known:
        return ""
    return f"{module} has no message or service {name}{did_you_mean(name, sorted(known), ALIKE)}"


@cache
def _messages(package: str, kind: str) -> frozenset[str]:
    """The classes made of a package's msg/ or srv/; none if more may be in that module."""
    known: set[str] = set()
    for folder in (Path(place, kind) for place in _places(package)):
        init = folder / "__init__.py"
        if init.is_file():
            if not GENERATED.fullmatch(text_of(init)):
                return frozenset()
            known |= {path.stem[1:] + ending for path in folder.glob("_[!_]*.py")
                      for ending in ENDINGS[kind]}
    return frozenset(known)


def source_of(folder: Path) -> Source:
    """Where the modules of a package may be, as far as its place tells: a workspace's src/."""
    if not (folder / "package.xml").is_file():
        return folder, False
    sources = [each for each in folder.parents if each.name == "src"] or [folder]
    # A cloned repository may have a src/ of its own.
    return next((each for each in sources[::-1] if any(
        (each.parent / name).exists() for name in OF_WORKSPACES)), sources[0]), True


def text_of(path: Path) -> str:
    """A file's text; none if it cannot be read, which must not end the check of others."""
    try:
        return path.read_text("utf-8", "replace")
    except OSError:
        return ""


@cache
def _names_below(folder: Path, deep: bool) -> frozenset[str]:
    """The names of modules and packages below a folder, also those that a build will make."""
    found = set()
    for place, below, files in itertools.islice(walk(folder), None if deep else 1):
        found |= {*below, os.path.basename(place)}
        for name in files:
            stem, _, ending = name.partition(".")
            if name.endswith(SOURCES):
                found.add(f"{stem}_pb2" if ending == "proto" else stem)
            elif name == "package.xml":
                found.update(NAME.findall(text_of(Path(place, name))))
            elif name == "CMakeLists.txt":
                found.update(BUILT.findall(text_of(Path(place, name))))
    return frozenset(found)


def walk(folder: Path) -> Iterator[tuple[str, list[str], list[str]]]:
    """os.walk with links, each folder once, without hidden ones and virtual environments."""
    seen = set()
    for place, below, files in os.walk(folder, followlinks=True):
        below[:] = sorted(name for name in below if not name.startswith(".")
                          and not os.path.exists(os.path.join(place, name, "pyvenv.cfg")))
        if os.path.realpath(place) in seen:  # a link to a folder above
            below.clear()
            continue
        seen.add(os.path.realpath(place))
        yield place, below, sorted(files)
