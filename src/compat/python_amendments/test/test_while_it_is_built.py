"""Python's start says nothing while the packages that it amends with are not there yet."""

import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[1] / "src"
IMPORTS = "import catkin_pkg.condition, genpy.message, numpy, rospy, tf2_ros, yaml; print('done')"


@pytest.mark.parametrize("built", [[], ["python_amendments"]])
def test_scripts_run_without_a_line(built, tmp_path):
    for name in ("usercustomize.py", *built):
        (tmp_path / name).symlink_to(SOURCE / name)
    ros = "/usr/lib/python3/dist-packages"
    done = subprocess.run([sys.executable, "-c", IMPORTS], capture_output=True, text=True,
                          env={"PYTHONPATH": f"{tmp_path}:{ros}", "PATH": "/usr/bin:/bin"},
                          check=False, timeout=60)
    assert (done.stdout, done.stderr) == ("done\n", "")
