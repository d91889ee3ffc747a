"""The lane with the real simulator, in lockstep: people walk, the car drives, nothing is missed."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from evaluation.lane_encounters import CAR, read_recording

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "course_run.py"
LIMIT = 240.0  # s, wall
EARLY = "25"  # a seed with which the first person sets off within 3 s


@pytest.mark.timeout(LIMIT + 30)
def test_people_walk_while_the_car_keeps_its_lane(tmp_path):
    poses, out = tmp_path / "poses.txt", tmp_path / "out"
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "--course", "lane", "--launch", "evaluation", "lane.launch",
         "--fast", "--no-video", "--duration", "5", "--seed", EARLY, "--out", str(out),
         "--launch-arg", f"record:={poses}", "--launch-arg", "lockstep_timeout:=20",
         "--startup-timeout", "120"],
        capture_output=True, text=True, timeout=LIMIT,
    )
    assert done.returncode == 0 and "simulated s are over" in done.stdout, done.stdout + done.stderr
    report = json.loads((out / "report.json").read_text())
    assert report["frames_dropped"] == 0 and report["max_lateral_m"] < 0.1
    recording = read_recording(poses)
    car, person = recording[CAR], recording["pedestrian_1"]
    assert car[-1].x > 1.0
    assert person[-1].y - person[0].y > 0.3  # from the right of the lane towards it
