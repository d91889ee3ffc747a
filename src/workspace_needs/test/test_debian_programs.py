"""The Python programs of Debian's ROS packages that setup installs: this Python can run them.

None is started, which would take 12 s of processor: each is compiled, and its imports looked up.
"""

import os
import re
import subprocess
from collections import defaultdict
from pathlib import Path

import pytest
from workspace_needs.check.packages import has_interpreter, is_python
from workspace_needs.check.python_files import read_script
from workspace_needs.check.sources import script_findings
from workspace_needs.places import release

ROOT = Path(__file__).resolve().parents[3]


def told(*command: str) -> list[str]:
    return subprocess.run(["dpkg-query", *command], text=True, capture_output=True,
                          check=True).stdout.splitlines()


@pytest.fixture(scope="module")
def packages() -> set[str]:
    """Those of setup's list by name, and of each source of which one has a package.xml."""
    lists = "".join(map(Path.read_text, ROOT.glob(f"dependencies/{release()}-*/debian.txt")))
    named = re.findall(r"^(?:python3-)?ros[\w-]+", lists, re.MULTILINE)
    assert len(named) > 10
    ros = {line.partition(":")[0] for line in told("-S", "/usr/share/*/package.xml")}
    of_source = defaultdict(set)
    for line in told("-W", "-f", "${db:Status-Status} ${source:Package} ${Package}\n"):
        status, source, package = line.split()
        if status == "installed":
            of_source[source].add(package)
    return set(named).union(*(found for found in of_source.values() if found & ros))


def test_each_compiles_and_has_what_it_imports(packages):
    paths = [path for path in map(Path, sorted(set(told("-L", *packages)))) if path.is_file()]
    programs = [path for path in paths
                if os.access(path, os.X_OK) and has_interpreter(path) and is_python(path)]
    assert len(programs) > 50
    fail = {path: [each.how for each in script_findings(path)] for path in programs}
    fail |= {path: [read_script(path).fault] for path in {*paths} - {*programs}
             if path.suffix == ".py" and read_script(path).fault}
    assert [str(path) for path, why in fail.items() if why] == ["/usr/lib/rosbag/bag2png.py"]
