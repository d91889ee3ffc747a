"""`catkin_make` as pages type it: a package that asks for what nobody has does not stop the others.

catkin_make configures all packages in one run of CMake, which ends at the first that cannot find
a component. Those packages are left out by catkin's own CATKIN_BLACKLIST_PACKAGES.
"""

from __future__ import annotations

import itertools
import os
import sys
from pathlib import Path

from workspace_needs.verdicts import judge

REAL = "/usr/bin/catkin_make"


def main(argv: list[str] | None = None) -> None:
    """Says in a line which packages are left out, then becomes Debian's catkin_make."""
    args = list(sys.argv[1:] if argv is None else argv)
    os.execv(REAL, [REAL, *args, *left_out_options(args)])


def left_out_options(args: list[str]) -> list[str]:
    """What to add to the options of catkin_make; nothing where they already choose packages."""
    if {"-h", "--help"} & set(args) or any("LIST_PACKAGES" in word for word in args):
        return []
    source = _source(args)
    if not source.is_dir():
        return []  # catkin_make says what is wrong
    verdicts = judge(source)
    stopped = [verdict for verdict in verdicts if verdict.stops]
    for verdict in stopped:
        key, why = next(iter(verdict.stops.items()))
        print(f"{verdict.name} is left out: {key}: {why}", flush=True)
    missing = sorted({name for verdict in verdicts if not verdict.stops
                      for name in verdict.missing if name.endswith("-dev")})
    if missing:
        print(f"Not installed, if the build stops: {' '.join(missing)}; "
              f"rosrun workspace_needs deps {source.resolve().parent}", flush=True)
    return [f"-DCATKIN_BLACKLIST_PACKAGES={';'.join(verdict.name for verdict in stopped)}"]


def _source(args: list[str]) -> Path:
    """The src/ of the workspace that -C names, or in which it is typed; or what --source says."""
    values = dict(itertools.pairwise(args))
    base = Path(values.get("-C") or values.get("--directory") or ".")
    return base / values.get("--source", "src")
