"""The shipped policy as a node on the ROS course: the lap of its environment."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
import rospkg
from driving_courses.policy import load_policy

pytestmark = pytest.mark.processes

POLICY = Path(__file__).resolve().parent.parent / "policies" / "line_follow.json"


def course_run(out: Path, *more: str) -> subprocess.CompletedProcess:
    script = Path(rospkg.RosPack().get_path("evaluation")) / "scripts" / "course_run.py"
    command = [sys.executable, script, "--launch", "driving_courses", "line_follow.launch",
               "--fast", "--no-video", "--startup-timeout", "150", "--out", out,
               "--launch-arg", "lockstep_timeout:=20", *more]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=1200)


@pytest.mark.timeout(1300)
def test_the_node_drives_the_lap_that_the_environment_drove_with_larger_pictures(tmp_path):
    score = load_policy(POLICY).score
    done = course_run(tmp_path, "--follower", POLICY.name, "--camera", "320x180")
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["lap_times_s"] == pytest.approx(score["lap_times_s"], rel=0.1)
    assert report["rms_lateral_m"] == pytest.approx(score["rms_lateral_m"], rel=0.1)
    assert report["frames_dropped"] == 0


def test_a_policy_that_is_none_is_one_line(tmp_path):
    path = tmp_path / "mine.json"
    path.write_text("{}", encoding="utf-8")
    done = course_run(tmp_path, "--follower", "mine.json", "--launch-arg", f"policy:={path}")
    assert done.returncode == 2
    assert "mine.json: no policy" in done.stdout + done.stderr
