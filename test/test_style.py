"""The style of all Python code, as `make lint` checks it."""

import subprocess
import sys
from pathlib import Path


def test_ruff_finds_nothing():
    ruff = Path(sys.executable).with_name("ruff")
    done = subprocess.run([ruff, "check", "--output-format=concise"], text=True,
                          cwd=Path(__file__).parents[1], capture_output=True)
    assert done.returncode == 0, done.stdout + done.stderr
