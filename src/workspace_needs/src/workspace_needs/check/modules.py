"""Which Python modules are here, seen without importing any, and why one is not."""

import itertools
import os
import pkgutil
import re
import sys
from collections.abc import Iterable
from difflib import get_close_matches
from functools import cache
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import find_spec
from pathlib import Path

from bullet_sim.errors import did_you_mean
from workspace_needs.tables import ABSENT, DEBIAN, OURS, tables

NAME = re.compile(r"<name>\s*(\w+)\s*</name>")
RELAY = re.compile(r"__extended_path = '([^']*)'")  # of catkin, which builds no copies of modules
FINDS_ITSELF = re.compile(r"sys\.modules|__path__")  # a package whose modules are anywhere
GENERATED = re.compile(r"(?:from \._\w+ import \*\s*)+")  # the __init__.py of messages
ENDINGS = {"msg": ("",), "srv": ("", "Request", "Response")}  # of classes made of a file
ALIKE = 0.75


def why_no_import(module: str, name: str, path: Path, folder: Path) -> str:
    """Why the script at `path` cannot `import module`, or `from module import name` if given.

    "" if it can or nobody knows. `folder`: of its package.
    """
    first = module.partition(".")[0]
    own = _names_below(path.parent, False) | _names_below(*_workspace(folder))
    if first in own:
        return ""  # perhaps made by a build
    if first in sys.stdlib_module_names or first in sys.modules or find_spec(first):
        if why := _why_no_submodule(module):
            return f"module {module} is not here: {why}"
        return _why_no_message(module, name)
    if tables().answer(first).kind == OURS:
        return ""
    return f"module {first} is not here: {_why_no_module(first, own)}"


def _why_no_module(name: str, own: Iterable[str]) -> str:
    if new := tables().renamed_modules.get(name):
        return f"Python 3 calls it {new}"
    known = {each.lower(): each for each in sorted({*own, *_all_modules()}) if each[0] != "_"}
    if name.lower() in known:
        return f"nobody has that name; is {known[name.lower()]} meant?"
    package = tables().module_packages.get(name, f"python3-{name.lower().replace('_', '-')}")
    if tables().answer(package).kind == DEBIAN:
        return f"sudo apt-get install {package}"
    answer = tables().answer(name)
    if answer.kind == ABSENT or "meant?" in answer.why:
        return answer.why
    if near := get_close_matches(name.lower(), known, 1, ALIKE):
        return f"nobody has that name; is {known[near[0]]} meant?"
    return f"Debian has no {package}; put what brings it beside the script or into src/"


@cache
def _all_modules() -> frozenset[str]:
    return sys.stdlib_module_names | {module.name for module in pkgutil.iter_modules()}


def _why_no_submodule(name: str) -> str:
    parent, *parts = name.split(".")
    places = _places(PathFinder.find_spec(parent)) if parts else []
    for part in parts:
        if not places:  # a module that makes others, say
            return ""
        spec = PathFinder.find_spec(f"{parent}.{part}", places)
        if spec is None:
            near = did_you_mean(part, [each.name for each in pkgutil.iter_modules(places)], ALIKE)
            return f"{parent} has no module {part}{near}"
        parent, places = spec.name, _places(spec)
    return ""


def _places(spec: ModuleSpec | None) -> list[str]:
    """The folders of a package's modules; none if that is known only once it is imported."""
    if spec is None or not spec.submodule_search_locations or not spec.origin:
        return []
    text = Path(spec.origin).read_text("utf-8", "replace")
    if relay := RELAY.search(text):
        return [os.path.join(place, spec.name) for place in (*relay[1].split(";"), *sys.path)]
    return [] if FINDS_ITSELF.search(text) else list(spec.submodule_search_locations)


def _why_no_message(module: str, name: str) -> str:
    package, _, kind = module.partition(".")
    if kind not in ENDINGS or name.startswith("_") or name in ("", "*"):
        return ""
    known: set[str] = set()
    for folder in (Path(place, kind) for place in _places(PathFinder.find_spec(package))):
        init = folder / "__init__.py"
        if init.is_file():
            if not GENERATED.fullmatch(init.read_text("utf-8", "replace")):
                return ""
            known |= {path.stem[1:] + ending for path in folder.glob("_[!_]*.py")
                      for ending in ENDINGS[kind]}
    if not known or name in known:
        return ""
    return f"{module} has no message or service {name}{did_you_mean(name, sorted(known), ALIKE)}"


def _workspace(folder: Path) -> tuple[Path, bool]:
    """Where the modules of a package may be, and whether its folders are looked through."""
    if not (folder / "package.xml").is_file():
        return folder, False
    return next((each for each in folder.parents if each.name == "src"), folder), True


@cache
def _names_below(folder: Path, deep: bool) -> frozenset[str]:
    """The names of modules and packages below a folder, also those that a build will make."""
    found, seen = set(), set()
    walk = os.walk(folder, followlinks=True)
    for place, below, files in itertools.islice(walk, None if deep else 1):
        if os.path.realpath(place) in seen:  # a link to a folder above
            below.clear()
            continue
        seen.add(os.path.realpath(place))
        if not deep:
            found.update(below)
        modules = {name.partition(".")[0] for name in files if name.endswith((".py", ".so"))}
        if modules or "package.xml" in files:
            found |= {*modules, os.path.basename(place)}
        if "package.xml" in files:
            found.update(NAME.findall(Path(place, "package.xml").read_text("utf-8", "replace")))
    return frozenset(found)
