"""The main job with the real simulator: a lap by each follower, equal runs, a part that dies."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "course_run.py"
LAP_LIMIT = 420.0  # s, wall, for a lap of 70 simulated seconds on a slow machine
START_LIMIT = 150.0  # s, wall
END_LIMIT = 60.0  # s, wall, to notice a death and clean up


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
def test_a_follower_closes_its_lap_near_the_line(tmp_path):
    report = drive(tmp_path / "out", 0, LAP_LIMIT, "--laps", "1", "--fast", "--camera", "320x240",
                   "--follower", "07follower_ground.py")
    assert report["laps_closed"] == 1
    assert report["rms_lateral_m"] <= 0.02
    assert report["distance_m"] > 9.0
    for name in ("path.png", "run.mp4", "run.html"):
        assert (tmp_path / "out" / name).stat().st_size > 10_000


@pytest.mark.timeout(LAP_LIMIT + 30)
def test_the_tutorials_follower_keeps_the_line_in_real_time_with_the_whole_picture(tmp_path):
    report = drive(tmp_path / "out", 0, LAP_LIMIT, "--duration", "12")  # no lap yet
    assert report["rms_lateral_m"] <= 0.06
    assert report["distance_m"] > 1.4
    assert report["frames_sent"] > 100


def drive(out: Path, code: int, limit: float, *options: str) -> dict:
    """The report of a run that ends with this code and leaves nothing running."""
    done = subprocess.run([sys.executable, str(SCRIPT), *options, "--out", str(out)],
                          capture_output=True, text=True, timeout=limit)
    assert done.returncode == code, done.stdout + done.stderr
    assert processes_of(out) == {}
    return json.loads((out / "report.json").read_text())


def drive_fast(out: Path, *options: str) -> dict:
    """The simulated figures of four seconds as fast as they go."""
    report = drive(out, 0, START_LIMIT, "--fast", "--duration", "4", "--fingerprint", *options)
    return {
        key: value
        for key, value in report.items()
        if key not in ("wall_s", "real_time_factor", "followers")
    }


def test_a_fast_drive_is_repeated_to_the_bit(tmp_path):
    options = ("--camera", "320x240", "--seed", "5", "--follower", "06follower_pid.py")
    first = drive_fast(tmp_path / "first", *options)
    assert drive_fast(tmp_path / "again", *options) == first
    assert first["frames_dropped"] == 0 and first["frames_sent"] > 100
    assert first["distance_m"] > 0.3
    sums = first["sensor_sha256"]
    assert set(sums) == {"/camera/rgb/image_raw", "/scan", "/imu", "/joint_states"}
    assert all(re.fullmatch("[0-9a-f]{64}", total) for total in sums.values())


def test_killing_the_simulator_ends_the_run_with_a_clear_line(tmp_path):
    out, log = tmp_path / "out", tmp_path / "log.txt"
    with log.open("wb") as output:
        run = subprocess.Popen(
            [sys.executable, str(SCRIPT), "--camera", "320x240", "--no-video", "--out", str(out)],
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    end = time.monotonic() + START_LIMIT
    while "simulated" not in log.read_text() and time.monotonic() < end:
        assert run.poll() is None, log.read_text()
        time.sleep(0.1)
    found = [pid for pid, line in processes_of(out).items() if "-m\0bullet_sim_ros" in line]
    assert found, processes_of(out)
    for pid in found:
        os.kill(pid, signal.SIGKILL)
    assert run.wait(END_LIMIT) == 2
    last = log.read_text().strip().splitlines()
    assert any("gazebo" in line for line in last), log.read_text()
    assert "Traceback" not in log.read_text()
    assert processes_of(out) == {}
