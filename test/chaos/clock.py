"""A clock that jumps for the processes of a round alone, by Debian's libfaketime."""

from __future__ import annotations

import os
from pathlib import Path

# Where apt-get install libfaketime puts it; LIBFAKETIME names another.
_FOUND = [Path(os.environ["LIBFAKETIME"])] if "LIBFAKETIME" in os.environ else sorted(
    Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
LIBRARY: Path | None = _FOUND[0] if _FOUND else None
FILE = "clock"  # in the round's folder


def set_clock(folder: Path, seconds: float) -> None:
    """Ahead of the machine's clock by so much."""
    half = folder / f"{FILE}.new"
    half.write_text(f"{seconds:+.3f}\n", encoding="utf-8")
    half.replace(folder / FILE)


def clock_environment(folder: Path) -> dict[str, str]:
    """For a program that is to have this folder's clock."""
    set_clock(folder, 0.0)
    # Python waits by CLOCK_MONOTONIC, which no change of the time moves.
    return {"LD_PRELOAD": str(LIBRARY), "FAKETIME_TIMESTAMP_FILE": str(folder / FILE),
            "FAKETIME_DONT_FAKE_MONOTONIC": "1", "FAKETIME_CACHE_DURATION": "1"}
