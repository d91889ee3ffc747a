"""The main job with the real simulator: a lap by each follower, and a part that dies."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parent.parent / "scripts" / "course_run.py"
LAP_LIMIT = 420.0  # s, wall, for a lap of 70 simulated seconds on a slow machine
START_LIMIT = 90.0  # s, wall
END_LIMIT = 15.0  # s, wall, to notice a death and clean up


def processes_of(out: Path) -> dict[int, str]:
    """Command lines of everything that this run started, by process id."""
    needle, found = f"ROS_LOG_DIR={out}/".encode(), {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if needle in (folder / "environ").read_bytes():
                found[int(folder.name)] = (folder / "cmdline").read_bytes().decode()
        except OSError:
            continue
    return found


@pytest.mark.timeout(LAP_LIMIT + 30)
@pytest.mark.parametrize(
    "follower, worst_rms", [("05follower_proporation.py", 0.06), ("06follower_pid.py", 0.02)]
)
def test_a_follower_closes_its_lap_near_the_line(tmp_path, follower, worst_rms):
    out = tmp_path / "out"
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "--laps", "1", "--follower", follower, "--out", str(out)],
        capture_output=True,
        text=True,
        timeout=LAP_LIMIT,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads((out / "report.json").read_text())
    assert report["laps_closed"] == 1
    assert report["rms_lateral_m"] <= worst_rms
    assert report["distance_m"] > 9.0
    for name in ("path.png", "run.mp4"):
        assert (out / name).stat().st_size > 10_000
    assert processes_of(out) == {}


@pytest.mark.parametrize(
    "victim, said",
    [
        (r"05follower_proporation\.py", "follower"),
        (r"bullet_sim_ros\.node", "gazebo"),
        (r"rosmaster", "roscore"),
    ],
)
def test_killing_a_part_ends_the_run_with_a_clear_line(tmp_path, victim, said):
    out, log = tmp_path / "out", tmp_path / "log.txt"
    with log.open("wb") as output:
        run = subprocess.Popen(
            [sys.executable, str(SCRIPT), "--out", str(out)],
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    end = time.monotonic() + START_LIMIT
    while "simulated" not in log.read_text() and time.monotonic() < end:
        assert run.poll() is None, log.read_text()
        time.sleep(0.1)
    found = [pid for pid, line in processes_of(out).items() if re.search(victim, line)]
    assert found, processes_of(out)
    for pid in found:
        os.kill(pid, signal.SIGKILL)
    assert run.wait(END_LIMIT) == 2
    last = log.read_text().strip().splitlines()
    assert any(said in line for line in last), log.read_text()
    assert "Traceback" not in log.read_text()
    assert processes_of(out) == {}
