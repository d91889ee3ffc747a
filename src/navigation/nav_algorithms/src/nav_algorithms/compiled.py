"""How this package compiles its inner loops with Numba."""

from __future__ import annotations

import hashlib
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numba
from numba.core import caching
from numba.core.typing import Signature

PACKAGE = Path(__file__).parent
INSTALLED = "dist-packages"  # the folder of Python modules in an install space
OURS = re.compile(rf"^from {PACKAGE.name}(?:\.([\w.]+))? import (\([^)]*\)|.*)", re.MULTILINE)


def compiled(signature: str | Signature) -> Callable[[Callable], Callable]:
    """Decorator: compiles for one signature at import and caches next to the source of a checkout.

    `signature` is Numba's, such as "f8(f8[:,::1], i8)", or of types, such as f8(GROUND, i8), for
    functions with a NamedTuple; GROUND is then `numba.typeof` of an example. The first import
    compiles, later ones load the cache: a node that compiled at its first scan would miss many
    scans. The GIL is released while the code runs. No fast-math and no threads: the same input
    gives the same bits.
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
    """The cache is stale if the function's file or a file that it imports from has changed.

    Numba only checks the function's own file, but machine code contains copies of what it calls.
    """

    def get_source_stamp(self) -> str:
        """A hash of the function's file and of all files of this package that it depends on."""
        files = sorted(_sources(Path(self._py_file)))
        return hashlib.sha256(b"".join(_text(file).encode() for file in files)).hexdigest()


class BesideSource(_StampOfAllSources, caching.InTreeCacheLocator):
    """Caches in __pycache__ next to the source of a checkout; never writes into an install."""

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> BesideSource | None:
        """None if the cache cannot be there."""
        return None if INSTALLED in PACKAGE.parts else super().from_function(py_func, py_file)


class InHome(_StampOfAllSources, caching.UserWideCacheLocator):
    """Caches in the user's cache folder, if the source's folder is not writable."""

    def ensure_cache_path(self) -> None:
        """Make the folder; the first compilation takes a while, so print a line about it."""
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
    """Paths of this package's modules that it may import, or import from; not all of them exist."""
    paths = set()
    for module, names in OURS.findall(_text(file)):
        folder = PACKAGE / module.replace(".", "/")
        paths.add(folder.with_suffix(".py"))
        paths |= {folder / f"{name}.py" for name in re.findall(r"\w+", names)}
    return paths


@cache
def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8")
