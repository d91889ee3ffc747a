"""A clock that jumps for the Python programs of a round alone (clock.c says how)."""

from __future__ import annotations

import struct
import subprocess
from pathlib import Path

SOURCE = Path(__file__).with_suffix(".c")
FILE = "clock"  # in the round's folder


def set_clock(folder: Path, seconds: float) -> None:
    """Ahead of the machine's clock by so much, from now on."""
    with (folder / FILE).open("r+b") as file:
        file.write(struct.pack("d", seconds))


def clock_environment(folder: Path) -> dict[str, str]:
    """For a program that is to have this folder's clock; CalledProcessError without a compiler."""
    library = folder / "clock.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(SOURCE)], check=True)
    (folder / FILE).write_bytes(struct.pack("d", 0.0))
    return {"LD_PRELOAD": str(library), "CHAOS_CLOCK": str(folder / FILE)}
