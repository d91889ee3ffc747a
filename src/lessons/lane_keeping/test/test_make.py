"""`make go` and the others drive only where there is a simulator."""

import os
import subprocess
from pathlib import Path

import pytest

LESSON = Path(__file__).resolve().parents[1]
OF_MAKE = ("MAKELEVEL", "MAKEFLAGS", "MFLAGS")


@pytest.mark.parametrize("command", ["go", "left", "right", "stop"])
@pytest.mark.parametrize(("nodes", "line"), [
    ("exit 1", "No ROS master: first type make sim in another terminal."),
    ("echo /rosout", "No simulator runs: first type make sim in another terminal.")])
def test_without_a_simulator(tmp_path, command, nodes, line):
    rosnode = tmp_path / "rosnode"
    rosnode.write_text(f"#!/bin/sh\n{nodes}\n")
    rosnode.chmod(0o755)
    there = {name: value for name, value in os.environ.items() if name not in OF_MAKE}
    done = subprocess.run(
        ["make", "-C", LESSON, command], text=True, capture_output=True, timeout=60,
        env=there | {"PATH": f"{tmp_path}:{there['PATH']}", "LC_ALL": "C"})
    assert done.returncode == 2
    assert done.stderr.splitlines()[0] == line
