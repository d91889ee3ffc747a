"""What CMake finds out about the compilers, once for all packages that are configured in one go.

It compiles six programs for that, which takes it longer than many a package. A build folder in
which it finds the files that it then writes, CMakeFiles/VERSION, is as one that it has configured
before.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path

EMPTY = "cmake_minimum_required(VERSION 3.5)\nproject(compilers)\n"
CHOOSES = re.compile(r"\bset\s*\(\s*(ENV\{(CC|CXX)\}|CMAKE_\w*(COMPILER|TOOLCHAIN_FILE)\b)",
                     re.IGNORECASE)
KNOWN = "-DCMAKE_PLATFORM_INFO_INITIALIZED:INTERNAL=1"


def find_compilers(folder: Path, words: Iterable[str]) -> Path | None:
    """The folder with CMake's findings in a new `folder`; None if it finds no working compilers.

    `words` are the user's own -D options.
    """
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(EMPTY, "utf-8")
    done = subprocess.run(["cmake", "-Wno-dev", *words, "."], cwd=folder, check=False,
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL)
    found = next(folder.glob("CMakeFiles/*/CMakeCXXCompiler.cmake"), None)
    return found.parent if found and not done.returncode else None


def give_compilers(found: Path | None, build: Path, files: Iterable[Path]) -> list[str]:
    """Puts the findings into a build folder; the option by which CMake takes them.

    Not where one of the package's files chooses compilers itself.
    """
    scripts = (path for path in files if path.name == "CMakeLists.txt" or path.suffix == ".cmake")
    if found is None or any(CHOOSES.search(path.read_text("utf-8", "replace"))
                            for path in scripts):
        return []
    shutil.copytree(found, build / "CMakeFiles" / found.name,
                    ignore=shutil.ignore_patterns("CompilerId*"))
    return [KNOWN]
