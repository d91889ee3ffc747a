"""What CMake has found out about the compilers, kept for the packages that it configures later.

It compiles two programs to know a compiler, and one to know its threads: a quarter of the time for
a small package. What it finds in a build folder it does not find out again.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import re
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path

from workspace_needs.places import kept_folder

FOUND = "CMakeFiles/[0-9]*/CMake*.cmake"  # of a build folder, by CMake's version
CACHE = "CMakeCache.txt"
THREADS = re.compile(r"^CMAKE_HAVE_LIBC_PTHREAD:INTERNAL=.*$", re.MULTILINE)
VARIABLES = ("CC", "CXX", "CPPFLAGS", "CFLAGS", "CXXFLAGS", "LDFLAGS")  # of the environment
CHOICE = re.compile(r"\bCMAKE_C(XX)?_COMPILER\b|TOOLCHAIN")


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
