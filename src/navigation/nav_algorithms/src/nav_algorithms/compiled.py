"""The one way in which this package compiles its inner loops."""

from __future__ import annotations

import hashlib
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numba
from numba.core import caching

PACKAGE = Path(__file__).parent
INSTALLED = "dist-packages"  # the folder of Python modules in an install space
OURS = re.compile(rf"^from {PACKAGE.name}(?:\.([\w.]+))? import (\([^)]*\)|.*)", re.MULTILINE)


def compiled(signature: str) -> Callable[[Callable], Callable]:
    """Decorator: machine code for one signature, at import, kept beside the source of a checkout.

    `signature` is Numba's, such as "f8(f8[:,::1], i8)". The first import compiles, every later one
    reads what was kept: a node that compiled when its first scan came would miss many. The lock is
    let go while it runs. No fast-math and no threads: the same input gives the same bits.
    """
    def compile_one(function: Callable) -> Callable:
        usual = numba.config.CACHE_LOCATOR_CLASSES
        numba.config.CACHE_LOCATOR_CLASSES = f"{__name__}.BesideSource,{__name__}.InHome"
        try:
            return numba.njit(signature, cache=True, nogil=True)(function)
        finally:
            numba.config.CACHE_LOCATOR_CLASSES = usual

    return compile_one


class _StampOfAllSources:
    """What was kept is stale when a file that this one imports from has changed, too.

    Numba looks at the function's own file only, but machine code holds copies of what it calls.
    """

    def get_source_stamp(self) -> str:
        """Of the text of the function's file and of all of ours that it leads to."""
        files = sorted(_sources(Path(self._py_file)))
        return hashlib.sha256(b"".join(_text(file).encode() for file in files)).hexdigest()


class BesideSource(_StampOfAllSources, caching.InTreeCacheLocator):
    """In __pycache__ beside the source of a checkout; where it is installed nobody writes."""

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> BesideSource | None:
        """None where it cannot be kept there."""
        return None if INSTALLED in PACKAGE.parts else super().from_function(py_func, py_file)


class InHome(_StampOfAllSources, caching.UserWideCacheLocator):
    """In the user's cache folder, where the source's folder is not ours to write in."""

    def ensure_cache_path(self) -> None:
        """Make the folder; what is compiled then for the first time takes a while, so say so."""
        folder = Path(self.get_cache_path())
        if not folder.exists():
            _say_once(folder.parent)
        super().ensure_cache_path()


@cache
def _say_once(folder: Path) -> None:
    print(f"{PACKAGE.name}: compiling the inner loops for this processor, once: about half a "
          f"minute (kept in {folder})", file=sys.stderr, flush=True)


def _sources(file: Path) -> set[Path]:
    found, new = set(), {file}
    while new:
        found |= new
        new = {path for file in new for path in _imported(file) if path.exists()} - found
    return found


def _imported(file: Path) -> set[Path]:
    """Where modules of ours that it imports, or imports from, would be."""
    paths = set()
    for module, names in OURS.findall(_text(file)):
        folder = PACKAGE / module.replace(".", "/")
        paths.add(folder.with_suffix(".py"))
        paths |= {folder / f"{name}.py" for name in re.findall(r"\w+", names)}
    return paths


@cache
def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8")
