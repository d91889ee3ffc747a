"""What CMake itself says of packages: each is configured in a folder that is thrown away.

CMake reads a CMakeLists.txt as the build will, whatever form its find_package has and in whichever
folder it stands. A package that fails is configured once more with a dependency provider
(cmake/what_is_asked.cmake) that names all that is absent. Results are kept until CMake files, names
of files, include lines, Debian's packages, the sourced workspaces or this package change.

To know a compiler CMake compiles two programs, and one to know its threads: a quarter of the time
for a small package. So what it found is kept for the packages that it configures later.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import asdict, dataclass, fields
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from workspace_needs.build_cause import in_one_line
from workspace_needs.places import hook, kept_folder, package_folder
from workspace_needs.workspace import Package, WorkspaceError

FOUND = "CMakeFiles/[0-9]*/CMake*.cmake"  # of a build folder, by CMake's version
CACHE = "CMakeCache.txt"
THREADS = re.compile(r"^CMAKE_HAVE_LIBC_PTHREAD:INTERNAL=.*$", re.MULTILINE)
VARIABLES = ("CC", "CXX", "CPPFLAGS", "CFLAGS", "CXXFLAGS", "LDFLAGS")  # of the environment
CHOICE = re.compile(r"\bCMAKE_C(XX)?_COMPILER\b|TOOLCHAIN")
# CMake asks distutils where Python is; to load setuptools' copy of that takes ten times as long.
# Later Pythons have none of their own.
OWN_DISTUTILS = {"SETUPTOOLS_USE_DISTUTILS": "stdlib"} if sys.version_info < (3, 12) else {}
LIMIT = 300.0  # s, wall, for one package; some fetch sources while they are configured
MOST_KEPT = 4000  # results
LEFT_OUT = re.compile(r": target (\S+) is left out: (.+?)\. What the simulator has in its place")
NO_MODULES = re.compile(r"required packages were not found:\s*((?:- \S+\s*)+)")
NO_MODULE = re.compile(r"^-- +(?:No p|P)ackage '([^']+)'.*\n(?:--.*\n)*CMake Error at .*\n"
                       r" *A required package was not found", re.MULTILINE)
QUERY = ".cmake/api/v1/query/codemodel-v2"  # CMake's file API answers into ../../reply
RULE = re.compile(r"^(\S+): (\S+)$", re.MULTILINE)  # of a Makefile without commands
CHOICES = ("-DCATKIN_WHITELIST_PACKAGES", "-DCATKIN_BLACKLIST_PACKAGES")  # what is built, not how
DPKG = Path("/var/lib/dpkg/status")


class Compilers:
    """The compilers that CMake takes with these -D options, unless a package chooses others."""

    def __init__(self, words: Iterable[str]):
        tools = [shutil.which(name) for name in ("cmake", "cc", "c++")]
        known = (platform.release(), [(tool, tool and os.stat(tool).st_mtime_ns) for tool in tools],
                 [os.environ.get(name) for name in VARIABLES],
                 [word for word in words if word.startswith("-DCMAKE_")])
        self._folder = kept_folder("compilers") / hashlib.sha256(repr(known).encode()).hexdigest()

    def put_into(self, build: Path) -> None:
        """Gives a new build folder what is known."""
        if (self._folder / CACHE).is_file():
            shutil.copytree(self._folder, build, dirs_exist_ok=True)

    def keep(self, build: Path) -> None:
        """Adds what CMake has found out in a build folder; what is longer is more complete."""
        with contextlib.suppress(OSError):
            threads = THREADS.findall((build / CACHE).read_text("utf-8"))
            texts = {path.relative_to(build): path.read_text("utf-8") for path in build.glob(FOUND)}
            texts[Path(CACHE)] = "\n".join(["CMAKE_PLATFORM_INFO_INITIALIZED:INTERNAL=1", *threads])
            for name, text in texts.items():
                place = self._folder / name
                if not place.exists() or place.stat().st_size < len(text.encode()):
                    _replace(place, text)


def chooses(files: Iterable[Path]) -> bool:
    """Whether a package's CMake files may name a compiler."""
    return any(CHOICE.search(path.read_text("utf-8", "replace")) for path in files
               if path.name == "CMakeLists.txt" or path.suffix == ".cmake")


def _replace(place: Path, text: str) -> None:
    """Writes a file that others may be reading."""
    place.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=place.parent, prefix=".", encoding="utf-8",
                                     delete=False) as file:
        file.write(text)
    os.replace(file.name, place)


@dataclass(frozen=True)
class Configured:
    """What CMake says of one package."""

    error: str = ""  # the first one, in one line; empty: it configures
    absent: tuple[str, ...] = ()  # names that it requires and that were not found
    left_out: tuple[tuple[str, str], ...] = ()  # targets without their sources, and why
    targets: tuple[str, ...] = ()  # its programs and libraries
    programs: tuple[str, ...] = ()  # file names of what rosrun starts once it is built
    sources: tuple[str, ...] = ()  # what its targets compile, by the path below its folder


def configure(packages: Iterable[Package], words: Iterable[str] = ()) -> dict[str, Configured]:
    """What CMake says of each package; `words` are the user's own -D options.

    A package without CMakeLists.txt has no entry, and none has one where nothing can be built.
    WorkspaceError if packages depend on one another in a circle.
    """
    packages = {package.name: package for package in packages
                if (package.folder / "CMakeLists.txt").is_file() and not package.unfit}
    if not packages or not all(map(shutil.which, ("cmake", "c++", "make"))):
        return {}
    graph = _order(packages)
    words = [word for word in words if word.startswith("-D") and not word.startswith(CHOICES)]
    try:
        order = list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        circle = _circle(error.args[1][0], packages)
        raise WorkspaceError("packages depend on one another in a circle: "
                             f"{' -> '.join(circle)}; remove one of these dependencies "
                             "from its package.xml") from error
    digests = _digests(packages, graph, order, words)
    store = kept_folder("configured-packages") / "results.json"
    kept = _read(store)
    found = {name: _result(kept[digests[name]]) for name in order if digests[name] in kept}
    needed = _with_dependencies(packages.keys() - found.keys(), graph)
    if needed:
        fresh = _Run({name: packages[name] for name in order if name in needed}, graph, words).all()
        found.update(fresh)
        _write(store, kept | {digests[name]: asdict(result) for name, result in fresh.items()})
    return found


def _order(packages: Mapping[str, Package]) -> dict[str, set[str]]:
    """The packages that each is configured after, as catkin orders them: those that it is built
    with, and all that these run with. What it runs with itself may be built with it."""
    run = {name: packages.keys() & package.run_with for name, package in packages.items()}
    return {name: _with_dependencies(packages.keys() & package.built_with, run)
            for name, package in packages.items()}


def _circle(name: str, packages: Mapping[str, Package]) -> list[str]:
    """The shortest way from a package back to it, by what package.xml files declare."""
    chains, seen = [[name]], set()
    for chain in chains:  # grows
        package = packages[chain[-1]]
        for other in sorted(packages.keys() & (package.built_with | package.run_with)):
            if other == name:
                return [*chain, name]
            if other not in seen:
                seen.add(other)
                chains.append([*chain, other])
    return [name]


def _result(kept: Mapping) -> Configured:
    return Configured(kept["error"], tuple(kept["absent"]),
                      tuple((target, why) for target, why in kept["left_out"]),
                      *(tuple(kept[key]) for key in ("targets", "programs", "sources")))


def _with_dependencies(names: Iterable[str], graph: Mapping[str, set[str]]) -> set[str]:
    """The names and all that they depend on: CMake must find the latter's configuration files."""
    waiting, found = list(names), set()
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += graph[name]
    return found


class _Run:
    """One configuration of several packages, those first that others depend on."""

    def __init__(self, packages: Mapping[str, Package], graph: Mapping[str, set[str]],
                 words: list[str]):
        self._packages = packages
        self._graph = {name: graph[name] for name in packages}
        self._words = words
        self._compilers = Compilers(words)
        self._processes: set[subprocess.Popen] = set()

    def all(self) -> dict[str, Configured]:
        """By name, in as many processes at once as there are processors."""
        found: dict[str, Configured] = {}
        sorter = TopologicalSorter(self._graph)
        sorter.prepare()
        running: dict[Future, str] = {}
        with (tempfile.TemporaryDirectory(prefix="configured-") as place,
              ThreadPoolExecutor(os.cpu_count() or 1) as pool):
            try:
                while sorter.is_active():
                    running |= {pool.submit(self._one, name, Path(place)): name
                                for name in sorter.get_ready()}
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        found[running[future]] = future.result()
                        sorter.done(running.pop(future))
            except KeyboardInterrupt:  # which their sessions do not get
                pool.shutdown(wait=False, cancel_futures=True)
                for process in tuple(self._processes):
                    _kill(process)
                raise
        return found

    def _one(self, name: str, place: Path) -> Configured:
        code, said = self._cmake(name, place)
        left_out = tuple(dict.fromkeys(LEFT_OUT.findall(" ".join(said.split()))))
        if not code:
            folder = self._packages[name].folder.resolve()
            targets = _targets(place / "build" / name, folder)
            made = _made(targets, place / "build" / name)
            _pretend_built(targets, place / "devel" / name / "lib")
            relays = place / "devel" / name / "lib" / name  # of catkin_install_python
            programs = {path.name for path in relays.glob("*")} | {
                target["nameOnDisk"] for target in made if target["type"] == "EXECUTABLE"
                and target["name"] not in dict(left_out)}
            return Configured(left_out=left_out, programs=tuple(sorted(programs)),
                              sources=_sources(made),
                              targets=tuple(target["name"] for target in targets))
        shutil.rmtree(place / "devel" / name, ignore_errors=True)  # so that no other finds it
        names, told = [], said
        if "(find_package)" in said.lower():  # the place of each error for what was not found
            names, second = self._absent(name, place)
            told += second
        names += NO_MODULE.findall(told)  # by pkg_check_modules
        names += " ".join(NO_MODULES.findall(told)).replace("- ", "").split()
        return Configured(in_one_line(said), tuple(dict.fromkeys(names)), left_out)

    def _absent(self, name: str, place: Path) -> tuple[list[str], str]:
        """All that a package requires and CMake does not find, and what CMake says then."""
        absent = place / f"{name}.absent"
        absent.touch()
        provider = package_folder() / "cmake/what_is_asked.cmake"
        said = self._cmake(name, place, f"-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES={provider}",
                           f"-DWORKSPACE_NEEDS_ABSENT={absent}")[1]
        shutil.rmtree(place / "devel" / name, ignore_errors=True)
        return absent.read_text("utf-8").split(), said

    def _cmake(self, name: str, place: Path, *more: str) -> tuple[int, str]:
        build = place / "build" / name
        shutil.rmtree(build, ignore_errors=True)
        (build / QUERY).mkdir(parents=True)
        known = None if chooses(self._packages[name].files) else self._compilers
        if known:
            known.put_into(build)
        below = [str(place / "devel" / other)
                 for other in _with_dependencies(self._graph[name], self._graph)]
        prefixes = [*below, *os.environ.get("CMAKE_PREFIX_PATH", "").split(":")]
        command = ["cmake", str(self._packages[name].folder.resolve()), "-Wno-dev", *hook(),
                   "-GUnix Makefiles", *self._words,
                   f"-DCATKIN_DEVEL_PREFIX={place / 'devel' / name}",
                   f"-DCMAKE_PREFIX_PATH={';'.join(filter(None, prefixes))}", *more]
        with subprocess.Popen(command, cwd=build, stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              errors="replace", start_new_session=True,
                              env=os.environ | OWN_DISTUTILS) as process:
            self._processes.add(process)
            try:
                said, _ = process.communicate(timeout=LIMIT)
            except subprocess.TimeoutExpired:
                _kill(process)
                return 1, ("CMake Error at CMakeLists.txt:1 (project):\n"
                           f"  no end within {LIMIT:.0f} s\n")
            finally:
                self._processes.remove(process)
        if known:
            known.keep(build)
        return process.returncode, said


def _kill(process: subprocess.Popen) -> None:
    """The process and all that it started, such as compilers and downloads."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _targets(build: Path, folder: Path) -> list[dict]:
    """The programs and libraries that a package's own folders define, by CMake's file API."""
    reply = (build / QUERY).parents[1] / "reply"
    model = json.loads(next(reply.glob("codemodel-v2-*.json")).read_text("utf-8"))["configurations"]
    found = []
    for entry in model[0]["targets"]:
        target = json.loads((reply / entry["jsonFile"]).read_text("utf-8"))
        place = folder / model[0]["directories"][entry["directoryIndex"]]["source"]
        if target["type"] != "UTILITY" and folder in (place, *place.parents):
            found.append(target)
    return found


def _made(targets: Iterable[dict], build: Path) -> list[dict]:
    """Those that `make` makes: not all with EXCLUDE_FROM_ALL, which the file API does not tell."""
    rules: dict[str, set[str]] = defaultdict(set)
    for name, needed in RULE.findall((build / "CMakeFiles/Makefile2").read_text("utf-8")):
        rules[name].add(needed)
    made = _with_dependencies(["all"], rules)
    return [target for target in targets if str(
        Path(target["paths"]["build"], "CMakeFiles", f"{target['name']}.dir", "all")) in made]


def _sources(targets: Iterable[Mapping]) -> tuple[str, ...]:
    """The files that these targets compile."""
    return tuple(sorted({source["path"] for target in targets
                         for source in target.get("sources", ()) if "compileGroupIndex" in source}))


def _pretend_built(targets: Iterable[Mapping], folder: Path) -> None:
    """Put an empty file where each library will be: catkin looks for those that a package exports
    while it configures the packages that depend on it."""
    folder.mkdir(parents=True, exist_ok=True)
    for target in targets:
        if target["type"] in ("SHARED_LIBRARY", "STATIC_LIBRARY", "MODULE_LIBRARY"):
            (folder / target["nameOnDisk"]).touch()


def _digests(packages: Mapping[str, Package], graph: Mapping[str, set[str]], order: list[str],
             words: list[str]) -> dict[str, str]:
    """For each package, a digest of what CMake's answer depends on."""
    machine = [*(field.name for field in fields(Configured)), *words, *hook(),
               os.environ.get("CMAKE_PREFIX_PATH", ""),
               str(DPKG.stat().st_mtime_ns if DPKG.exists() else 0)]
    deciding = (*sorted(Path(__file__).parent.glob("*.py")),  # they make results of CMake's words
                package_folder() / "cmake/what_is_asked.cmake",
                *(Path(word.partition("=")[2]) for word in hook()))
    machine += [path.read_text("utf-8") for path in deciding]
    found: dict[str, str] = {}
    for name in order:
        package = packages[name]
        digest = hashlib.sha256(repr((machine, str(package.folder.resolve()), package.includes,
                                      sorted(found[other] for other in graph[name]))).encode())
        for path in package.files:
            digest.update(str(path).encode())
            if path.name == "CMakeLists.txt" or path.suffix in (".cmake", ".in", ".xml"):
                digest.update(path.read_bytes())
        found[name] = digest.hexdigest()
    return found


def _read(store: Path) -> dict[str, dict]:
    try:
        return json.loads(store.read_text("utf-8"))
    except (OSError, ValueError):  # none yet, or cut off
        return {}


def _write(store: Path, kept: Mapping[str, dict]) -> None:
    """Replaces the file as a whole; a folder that cannot be written costs the next run its time."""
    try:
        store.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=store.parent, delete=False) as file:
            json.dump(dict(list(kept.items())[-MOST_KEPT:]), file)
        os.replace(file.name, store)
    except OSError:
        return
