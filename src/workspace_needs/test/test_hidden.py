"""The line at sourcing, on packages that a learner's own hide."""

import os
import re
import subprocess
from pathlib import Path

import pytest

HOOK = Path(__file__).resolve().parents[1] / "env-hooks/52.workspace_needs.sh"


def built(folder: Path, *packages: str) -> Path:
    """A workspace that looks built, with these packages."""
    (folder / "devel").mkdir(parents=True)
    (folder / "devel/setup.bash").touch()
    for package in packages:
        (folder / "src" / package).mkdir(parents=True)
        (folder / "src" / package / "package.xml").touch()
    return folder


@pytest.mark.parametrize("shell", [["bash", "--norc"], ["sh"]])
@pytest.mark.parametrize(("theirs", "hidden"), [
    (["learning_topic", "a/car_control"], "car_control, learning_topic"), (["my_robot"], None)])
def test_sourcing_says_which_of_the_courses_packages_are_hidden(tmp_path, shell, theirs, hidden):
    ours, other = tmp_path / "courses", built(tmp_path / f"my_ws{tmp_path}/courses_2", *theirs)
    for name in ("learning_topic", "car_control", "xacro"):
        (ours / "devel/share" / name).mkdir(parents=True)
    environment = os.environ | {
        "CATKIN_ENV_HOOK_WORKSPACE": str(ours / "devel"), "LC_ALL": "C.UTF-8", "LANGUAGE": "en",
        "ROS_PACKAGE_PATH": f"{other}/src:{ours}/src:/usr/share",
        "PYTHONPATH": f"{HOOK.parents[1]}/src:{os.environ.get('PYTHONPATH', '')}"}
    for option, said in ((["-i"], bool(hidden)), ([], False)):
        done = subprocess.run([*shell, *option, "-c", f". {HOOK}; set"], text=True, env=environment,
                              capture_output=True, check=True, timeout=30)
        assert ("hides the courses' package" in done.stderr) is said, done.stderr
        assert not re.search("^_courses_", done.stdout, re.MULTILINE)
        if said:
            assert (f"Your own {hidden} hides" in done.stderr
                    and f"type: source {ours}/devel/setup.bash" in done.stderr)
    alone = environment | {"ROS_PACKAGE_PATH": f"{ours}/src:/usr/share"}
    done = subprocess.run([*shell, "-i", "-c", f". {HOOK}"], text=True, env=alone,
                          capture_output=True, check=True)
    assert "hides" not in done.stderr
