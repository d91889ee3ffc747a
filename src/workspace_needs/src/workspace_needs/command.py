"""The command line of `make deps`: installs what Debian has, reports what nobody has."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable
from pathlib import Path

from workspace_needs import apt
from workspace_needs.verdicts import Verdict, judge
from workspace_needs.workspace import WorkspaceError, source_folder


def main(argv: list[str] | None = None) -> int:
    """0: all that is available is installed; 1: apt failed; 2: there is no such workspace."""
    parser = argparse.ArgumentParser(
        prog="deps", description="Installs the Debian packages that a catkin workspace asks for.")
    parser.add_argument("workspace", type=Path, help="its folder, such as ~/catkin_ws")
    parser.add_argument("--simulate", action="store_true", help="only say what would be installed")
    args = parser.parse_args(argv)
    try:
        verdicts = _provide(source_folder(args.workspace), args.simulate)
    except WorkspaceError as error:
        print(f"deps: {error}", file=sys.stderr)
        return 2
    except apt.AptError as error:
        print(f"deps: {error}", file=sys.stderr)
        return 1
    for line in not_to_be_had(verdicts):
        print(line)
    return 0


def _provide(source: Path, simulate: bool) -> list[Verdict]:
    """Installs what is missing, and what CMake comes to ask for once it has found that."""
    tried: set[str] = set()
    while True:
        verdicts = judge(source)
        missing = {name for verdict in verdicts for name in verdict.missing} - tried
        if missing or not tried:
            _install(sorted(missing), len(verdicts), simulate, source)
        if simulate or not missing:
            return verdicts
        tried |= missing


def _install(missing: list[str], packages: int, simulate: bool, source: Path) -> None:
    of = "1 package" if packages == 1 else f"{packages} packages"
    usual = Path("~/catkin_ws/src").expanduser()
    if not packages and usual.is_dir() and not usual.samefile(source):
        print(f"{source}: no package of your own is in it; for those in ~/catkin_ws type: "
              "make deps WS=~/catkin_ws")
    elif not packages:
        print(f"{source}: no package of your own is in it; setup sees to those of this "
              "repository")
    elif not missing:
        print(f"{of}: all that Debian has for them is installed")
    elif simulate:
        print(f"{of}: to be installed: {' '.join(missing)}")
    else:
        print(f"{of}: installing {' '.join(missing)}", flush=True)
        apt.install(missing)


def not_to_be_had(verdicts: Iterable[Verdict]) -> list[str]:
    """One line for each package that will not be built, or dependency missing at run time."""
    lines = []
    for verdict in verdicts:
        lines += [f"{verdict.name} cannot be built: {key}: {why}"
                  for key, why in verdict.stops.items()]
        lines += [f"{verdict.name} cannot be built by catkin_make: {key}: {why}"
                  for key, why in verdict.clashes.items()]
        lines += [f"{verdict.name}: {file} is left out: {why}"
                  for file, why in verdict.left_out.items()]
        lines += [f"{verdict.name}: {file} will not compile: {why}"
                  for file, why in verdict.uncompiled.items()]
        lines += [f"{verdict.name} will be without {key}: {why}"
                  for key, why in verdict.lacks.items()]
    return lines


if __name__ == "__main__":
    sys.exit(main())
