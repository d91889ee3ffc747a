#!/usr/bin/env python3
"""Writes the table in docs/workspace.md from what rosdep's files and data/absent.yaml say.

    python3 scripts/workspace_table.py            write it
    python3 scripts/workspace_table.py --check    exit code 1 if it is not what would be written
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "src/workspace_needs"
sys.path.insert(0, str(PACKAGE / "src"))

from workspace_needs.tables import Tables  # noqa: E402  (works where nothing is built)

BEGIN, END = "<!-- table: begin -->\n", "<!-- table: end -->\n"
RELEASE = "bookworm"
ROS_2 = ("ament_", "rosidl_", "rcutils", "rcpputils", "osrf_", "performance_test", "domain_",
         "test_interface", "SQLiteCpp")


def by_setup() -> set[str]:
    """Debian packages installed by setup, with their dependencies, by apt's lists."""
    path = ROOT / f"dependencies/{RELEASE}-amd64/debian.txt"
    text = re.sub(r"#.*", "", path.read_text("utf-8"))
    without = [f"--no-{kind}" for kind in
               ("recommends", "suggests", "conflicts", "breaks", "replaces", "enhances")]
    listed = subprocess.run(["apt-cache", "depends", "--recurse", *without, *text.split()],
                            capture_output=True, text=True, check=True).stdout
    return {line for line in listed.splitlines() if not line.startswith((" ", "<"))}


def table(tables: Tables, installed: set[str]) -> str:
    """Three parts: what is installed, what `make deps` installs, what nobody has."""
    plain = other_keys()
    ros = {key: rule["debian"][RELEASE] for key, rule in tables.debian.items()
           if "-" not in key and key not in plain and not key.startswith(ROS_2)
           and rule["debian"][RELEASE]}
    there = sorted(tables.ours | {key for key, names in ros.items() if installed.issuperset(names)})
    later = sorted(set(ros) - set(there))
    lines = ["| | packages |", "|---|---|",
             f"| included, or installed by setup ({len(there)}) | {_names(there)} |",
             f"| Debian has it, `make deps` installs it ({len(later)}, "
             "and several hundred keys of plain libraries and Python modules) | "
             f"{_names(later)} |", "", "| not available | such as | why |", "|---|---|---|"]
    lines += [f"| {row.what} | {_names(row.keys[:8])} | {row.why} |" for row in tables.absences]
    return "\n".join(lines) + "\n"


def other_keys() -> set[str]:
    """Keys that are no ROS packages, or metapackages."""
    system = yaml.safe_load((PACKAGE / "data/system_keys.yaml").read_text("utf-8"))
    flat = {name for row in system["same_name"] for name in row}
    return flat | set(system["keys"]) | set(system["groups"])


def _names(names) -> str:
    return ", ".join(f"`{name}`" for name in names)


def main() -> int:
    """Write, or compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing, only compare")
    check = parser.parse_args().check
    path = ROOT / "docs/workspace.md"
    text = path.read_text("utf-8")
    before, _, rest = text.partition(BEGIN)
    made = (before + BEGIN + table(Tables(PACKAGE, RELEASE), by_setup()) + END
            + rest.partition(END)[2])
    if made == text:
        return 0
    if check:
        print("docs/workspace.md is not up to date: python3 scripts/workspace_table.py",
              file=sys.stderr)
        return 1
    path.write_text(made, encoding="utf-8")
    print("written: docs/workspace.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
