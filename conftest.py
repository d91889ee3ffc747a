"""Keeps pytest away from the scripts that rostest runs: they need a master."""

import re
from pathlib import Path

ROOT = Path(__file__).parent
TEST_NODE = re.compile(r"<test\b[^>]*\btype=[\"']([^\"']+\.py)[\"']")


def rostest_scripts() -> list[str]:
    """The scripts that a .test file names, wherever they lie below its package's test/."""
    scripts = set()
    for launch in ROOT.glob("src/**/test/**/*.test"):
        for name in TEST_NODE.findall(launch.read_text(encoding="utf-8")):
            scripts.update(str(found) for found in launch.parent.rglob(name))
    return sorted(scripts)


collect_ignore = rostest_scripts()
