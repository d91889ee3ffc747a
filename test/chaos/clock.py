"""A clock that jumps only for the Python programs of a round (see clock.c)."""

from __future__ import annotations

import struct
import subprocess
from pathlib import Path

SOURCE = Path(__file__).with_suffix(".c")
FILE = "clock"  # in the round's folder


def set_clock(folder: Path, seconds: float) -> None:
    """Set the clock this far ahead of the machine's."""
    with (folder / FILE).open("r+b") as file:
        file.write(struct.pack("d", seconds))


def clock_environment(folder: Path) -> dict[str, str]:
    """Environment of a program with this folder's clock; CalledProcessError without a compiler."""
    library = folder / "clock.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(SOURCE)], check=True)
    (folder / FILE).write_bytes(struct.pack("d", 0.0))
    return {"LD_PRELOAD": str(library), "CHAOS_CLOCK": str(folder / FILE)}
