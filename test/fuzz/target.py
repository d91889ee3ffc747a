"""What a family of inputs says of itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hypothesis.strategies import SearchStrategy

ROOT = Path(__file__).resolve().parents[2]
THIS_FILE = b"THIS_FILE"  # in an input: the path of its own file


@dataclass(frozen=True)
class Target:
    """One reader of what strangers may send: files, messages, requests."""

    name: str
    file: str  # how the input's file is called: readers look at its end
    inputs: SearchStrategy[bytes]
    read: Callable[[Path], object]  # as roslaunch, `check` or the page reads the file
    refusals: tuple[type[Exception], ...]  # what it may raise instead, with one line
    beside: tuple[Path, ...] = ()  # files that lie in the input's folder


def found(*patterns: str, largest: int = 100_000) -> list[Path]:
    """The repository's own files of these patterns below src/ that are no larger, sorted."""
    files = [path for pattern in patterns for path in (ROOT / "src").glob(pattern)
             if path.is_file() and path.stat().st_size <= largest]
    if not files:
        raise FileNotFoundError(f"nothing fits {' '.join(patterns)} below src/")
    return sorted(files)
