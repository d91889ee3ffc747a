"""What a maker's result came from, so that it is made anew only when some of that has changed.

Setup runs before each command, and to import a maker of worlds alone takes half a second. A list in
.setup/made/ has each file that the maker imported, read or wrote, with its time and size.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from collections.abc import Iterable
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / ".setup/made"


def is_made(name: str, folder: Path = FOLDER) -> bool:
    """Whether all files are as they were when this maker ended."""
    try:
        known = json.loads((folder / f"{name}.json").read_text("utf-8"))
        return all(_state(path) == state for path, state in known.items())
    except (OSError, ValueError, AttributeError):  # none yet, cut off, or a file is gone
        return False


def keep(name: str, files: Iterable[Path], folder: Path = FOLDER) -> None:
    """Notes these files or folders and all modules; a folder that cannot be written costs time."""
    imported = [getattr(module, "__file__", None) for module in list(sys.modules.values())]
    with contextlib.suppress(OSError):
        known = {str(path): _state(path) for path in (*filter(None, imported), *files)}
        folder.mkdir(parents=True, exist_ok=True)
        new = folder / f"{name}.{os.getpid()}"
        new.write_text(json.dumps(known), encoding="utf-8")
        new.replace(folder / f"{name}.json")


def _state(path: str | Path) -> list[int]:
    """Modification time (ns) and size (bytes)."""
    found = os.stat(path)
    return [found.st_mtime_ns, found.st_size]
