"""Keeps pytest away from the scripts that rostest runs: they need a master.

Makes the models that come with the simulator, so that tests see their TOML files as they are now.
Skips what `make test FAST=1` has no time for.
"""

import os
import re
import runpy
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parent
TEST_NODE = re.compile(r"<test\b[^>]*\btype=[\"']([^\"']+\.py)[\"']")


def rostest_scripts() -> list[str]:
    """The scripts that a .test file names, wherever they lie below its package's test/."""
    scripts = set()
    for launch in ROOT.glob("src/**/test/**/*.test"):
        for name in TEST_NODE.findall(launch.read_text(encoding="utf-8")):
            scripts.update(str(found) for found in launch.parent.rglob(name))
    return sorted(scripts)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Begin no further test when the time that the runner gives is over."""
    if time.time() > float(os.environ.get("TESTS_BEGIN_UNTIL", "inf")):
        pytest.skip("left for make test")


runpy.run_path(str(ROOT / "src/sim/bullet_sim/src/bullet_sim/props.py"), run_name="__main__")
collect_ignore = rostest_scripts()
