"""Removes support for one tag at a time, and checks that the tests that name it fail.

    python3 scripts/conformance_audit.py [PART-OF-A-NAME]    every row and tag whose name has it

A plugin's tag is hidden from the plugin; an element of URDF or SDF is removed from the text before
parsing, and so is a construct of xacro; a service or topic is not offered, or lacks a field; a
launch file's argument has no effect; a model, world or package is not found. A test that still
passes proves nothing: it is listed, and the exit code is 1. Takes an hour; not part of `make test`.
What cannot be hidden like this was broken by hand.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import conformance

from bullet_sim_ros.interface import APPROXIMATED, WORKS, read_interface

ROOT = Path(__file__).resolve().parent.parent
LIMIT = 120.0  # s, for the tests of one tag
# fields that upstream always leaves at their default: hiding them changes nothing
EMPTY = {"/gazebo/get_model_properties/canonical_body_name", "/gazebo/get_joint_properties/type",
         "/gazebo/get_joint_properties/damping"}
# what can be hidden
AUDITED = re.compile(
    r"lib\S+\.so|/gazebo/\w+(/(?!light$)[\w.]+( \.\. \w+)?)?$|(sdf|urdf) [^(]+$|\w+\.launch/\w+$"
    r"|xacro (macro|property|include)($|/)|xacro (substitutions|expressions|tags)/"
    r"|(models: \w+|worlds|gazebo_plugins test_worlds|find_package\(catkin COMPONENTS\))/")


def files_of_functions() -> dict[str, set[str]]:
    """Test files by the functions in them; without rostest's scripts."""
    found: dict[str, set[str]] = defaultdict(set)
    for path in ROOT.glob("src/**/test/**/test_*.py"):
        for line in path.read_text(encoding="utf-8").splitlines():
            if begun := conformance.FUNCTION.match(line):
                found[begun[1]].add(str(path))
    return found


def survives(name: str, functions: set[str], files: dict[str, set[str]]) -> str | None:
    """A line if the tests pass although `name` is hidden; None if one fails, as it should."""
    nodes = sorted({path for function in functions for path in files.get(function, ())})
    if not nodes:
        return None  # rostest's
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "conformance_hide",
               "-k", " or ".join(sorted(functions)), *nodes]
    environment = dict(os.environ, CONFORMANCE_HIDE=name)
    environment["PYTHONPATH"] = f"{ROOT / 'scripts'}:{environment.get('PYTHONPATH', '')}"
    try:
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True,
                              timeout=LIMIT, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return None  # it waits for what is hidden
    if done.returncode == 0:
        return f"{name}: {', '.join(sorted(functions))} still pass"
    if done.returncode != 1:
        return f"{name}: pytest ended with {done.returncode}: {done.stdout[-300:]}"
    return None


def main() -> int:
    """Audit the table; returns the exit code."""
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    tests, files = conformance.covered(), files_of_functions()
    bad = tried = 0
    for section in read_interface():
        for row in section.rows:
            for name, entry in row.names():
                if (wanted not in name or entry.status not in (WORKS, APPROXIMATED)
                        or not tests.get(name) or not AUDITED.match(name) or name in EMPTY):
                    continue
                tried += 1
                line = survives(name, tests[name], files)
                if line:
                    bad += 1
                    print(line, flush=True)
    print(f"{tried} hidden, {bad} unnoticed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
