"""The main job against a stand-in simulator: each way to end, exit codes, nothing left running."""

import ast
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import pytest
from terminal_language.cells import width

from evaluation.command_line import NOT_RUN
from evaluation.course_run import CourseRun, followers_table
from evaluation.live import run_program_of

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "course_run.py"
FILMED = ("--launch", "evaluation", "fake_course.launch")
FAKE = (*FILMED, "--no-video")
END_TIME = 3.0  # s that Ctrl-C may take while nobody else wants the processors
LIMIT = 120.0  # s for anything else


def left_running(out: Path) -> list[int]:
    """Processes of the run: roscore and roslaunch hand their log folder down to all they start."""
    needle, found = f"ROS_LOG_DIR={out}/".encode(), []
    for environ in Path("/proc").glob("[0-9]*/environ"):
        try:
            if needle in environ.read_bytes():
                found.append(int(environ.parent.name))
        except OSError:
            continue
    return found


def end_time() -> float:
    """s that Ctrl-C may take now: everything takes as much longer as more wait for a processor."""
    return END_TIME * max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))


def wait_until(condition: Callable[[], object], limit: float, what: str) -> object:
    """The condition's value once it is true."""
    until = time.monotonic() + limit
    while time.monotonic() < until:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"not within {limit:g} s: {what}")


class Run:
    """course_run.py as a process, with its output in a file."""

    def __init__(self, out: Path, *arguments: str):
        self.out, self._log = out, out.parent / "output.txt"
        with self._log.open("wb") as output:
            self.process = subprocess.Popen(
                [sys.executable, str(SCRIPT), "--out", str(out), *arguments],
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @property
    def output(self) -> str:
        return self._log.read_text()

    def wait(self) -> int:
        code = self.process.wait(LIMIT)
        assert not left_running(self.out)
        return code

    def wait_for_driving(self) -> None:
        wait_until(lambda: "simulated" in self.output, LIMIT, "the car drives")

    def pid_of(self, pattern: str) -> int:
        """The only process of this run whose command line matches."""
        found = [
            pid
            for pid in left_running(self.out)
            if re.search(pattern, Path(f"/proc/{pid}/cmdline").read_bytes().decode())
        ]
        assert len(found) == 1, f"{pattern}: {found}"
        return found[0]

    @property
    def last_line(self) -> str:
        return self.output.splitlines()[-1]


@pytest.fixture
def start(tmp_path) -> Iterator[Callable[..., Run]]:
    """Starts runs with the stand-in, and ends what a failed test leaves."""
    runs = []

    def start_run(*arguments: str) -> Run:
        runs.append(Run(tmp_path / "course", *arguments))
        return runs[-1]

    yield start_run
    for run in runs:
        run.process.kill()
        run.process.wait()
        for pid in left_running(run.out):
            os.kill(pid, signal.SIGKILL)


def test_closed_laps_are_reported_and_kept_by_a_run_that_fails(start):
    run = start(*FAKE, "--laps", "2", "--launch-arg", "factor:=15")
    assert run.wait() == 0, run.output
    report = json.loads((run.out / "report.json").read_text())
    assert report["outcome"] == "closed" and report["laps_closed"] == 2
    assert report["rms_lateral_m"] == pytest.approx(0.03, abs=1e-3)
    assert report["lap_times_s"][1] == pytest.approx(10.023 / 0.15, rel=0.01)
    assert report["frames_sent"] > 1000
    assert 0 <= report["frames_dropped"] < report["frames_sent"]
    assert report["versions"]["numpy"]
    assert cv2.imread(str(run.out / "path.png")).shape[1] == 1400
    before = (run.out / "report.json").read_bytes()
    run = start(*FAKE, "--launch-arg", "behaviour:=no_car", "--launch-arg", "factor:=1",
                "--startup-timeout", "15")
    assert run.wait() == 2
    assert "the car (model turtlebot3_waffle) was not there" in run.last_line
    assert not (run.out / "report.json").exists()
    assert (run.out / "earlier" / "report.json").read_bytes() == before


FAST_S = 12  # s, simulated


@pytest.fixture(scope="module")
def fast_runs(tmp_path_factory) -> list[tuple[Run, dict]]:
    """Two equal ones at a time, each with a master of its own; and their reports."""
    runs = []
    for name in ("one", "another"):
        out = tmp_path_factory.mktemp(name) / "course"
        runs.append(Run(out, *FILMED, "--fast", "--duration", str(FAST_S), "--seed", "2"))
    try:
        assert [run.wait() for run in runs] == [0, 0], runs[0].output + runs[1].output
    finally:
        for run in runs:
            run.process.kill()
            run.process.wait()
    return [(run, report_of(run)) for run in runs]


def report_of(run: Run) -> dict:
    """What is the same in two equal runs."""
    report = json.loads((run.out / "report.json").read_text())
    for name in ("wall_s", "real_time_factor", "followers", "film"):
        del report[name]
    return report


def test_fast_runs_are_equal_to_the_last_figure(fast_runs):
    (_, report), (_, other) = fast_runs
    assert report == other
    assert report["frames_sent"] == 30 * FAST_S + 2 and report["frames_dropped"] == 0
    assert report["fast"] and report["seed"] == 2
    assert f"{FAST_S} simulated s are over: lap 1 was " in fast_runs[0][0].output
    assert len(report["drive_sha256"]) == 64


def test_a_drive_is_filmed_and_the_report_shows_followers_side_by_side(fast_runs):
    run = Run(fast_runs[0][0].out, *FILMED, "--laps", "1", "--duration", "6", "--launch-arg",
              "factor:=2", "--follower", "06follower_pid.py")
    assert run.wait() == 1, run.output
    report = json.loads((run.out / "report.json").read_text())
    assert list(report["followers"]) == ["05follower_proporation.py", "06follower_pid.py"]
    assert "> 06follower_pid.py" in run.output and "  05follower_proporation.py" in run.output
    assert "6 simulated s are over" in run.last_line
    film = cv2.VideoCapture(str(run.out / "run.mp4"))
    assert film.read()[0]
    filmed_s = film.get(cv2.CAP_PROP_FRAME_COUNT) * 0.2  # a busy machine may miss some pictures
    assert 3 < filmed_s < 8


def test_another_seed_is_another_drive_and_the_launch_file_is_told_all(fast_runs):
    before, other = fast_runs[1]
    run = Run(before.out, *FAKE, "--fast", "--camera", "64x48", "--seed", "7",
              "--duration", str(FAST_S))
    assert run.wait() == 0, run.output
    assert report_of(run)["drive_sha256"] != other["drive_sha256"]
    assert not (run.out / "run.mp4").exists()
    log = (run.out / "log" / "roslaunch.log").read_text()
    asked = ast.literal_eval(re.search("asked for (.*)", log)[1])
    assert asked.pop("run_log") == str(run.out / "run.log.gz")
    logged = json.loads(asked.pop("run_log_of"))
    assert logged["driver"] == "05follower_proporation.py" and "seed:=7" in logged["words"]
    assert asked == {
        "paused": True,
        "real_time_factor": "0",
        "lockstep": "/cmd_vel",
        "seed": 7,
        "camera_width": 64,
        "camera_height": 48,
    }


def test_time_begins_when_all_are_connected_and_the_last_image_is_waited_for(start):
    run = start(*FAKE, "--fast", "--duration", "5", "--launch-arg", "behaviour:=late_delays",
                "--launch-arg", "after:=0.752")
    assert run.wait() == 0, run.output
    report = json.loads((run.out / "report.json").read_text())
    assert report["frames_sent"] == 152 and report["frames_dropped"] == 0
    assert "without a command" not in run.output


def test_a_fast_follower_that_does_not_answer_is_told(start):
    run = start(*FAKE, "--fast", "--duration", "2", "--launch-arg", "behaviour:=mute")
    assert run.wait() == 0, run.output
    report = json.loads((run.out / "report.json").read_text())
    assert 0 < report["frames_dropped"] < report["frames_sent"]
    assert f"{report['frames_dropped']} images without a command" in run.output


def test_the_report_comes_before_the_film_and_a_second_ctrl_c_ends_that(
        start, tmp_path, monkeypatch):
    hanging = tmp_path / "bin" / "ffmpeg"
    hanging.parent.mkdir()
    hanging.write_text('#!/bin/sh\nhead -c 1 >&2\ntouch "$0.started"\nexec sleep 1000\n')
    hanging.chmod(0o755)
    monkeypatch.setenv("PATH", str(hanging.parent), prepend=os.pathsep)
    run = start(*FILMED)
    run.wait_for_driving()
    wait_until(hanging.with_name("ffmpeg.started").exists, LIMIT, "the film's first picture")
    run.process.send_signal(signal.SIGINT)
    wait_until((run.out / "report.json").exists, LIMIT, "the report")
    time.sleep(0.5)
    assert run.process.poll() is None
    run.process.send_signal(signal.SIGINT)
    assert run.wait() == 130, run.output
    report = json.loads((run.out / "report.json").read_text())
    assert report["outcome"] == "ended early" and report["film"] is None
    assert not (run.out / "run.mp4").exists()


def test_a_folder_of_somebody_else_s_logs_is_not_removed(start, tmp_path):
    diary = tmp_path / "course" / "log" / "diary.txt"
    diary.parent.mkdir(parents=True)
    diary.write_text("dear diary")
    run = start(*FAKE)
    assert run.wait() == 2
    assert "is not a folder of logs that a run wrote" in run.last_line
    assert diary.read_text() == "dear diary"


@pytest.mark.parametrize(
    ("behaviour", "words"),
    [("leaves", "the car left the course at x="), ("stalls", "the car stalled at x=")],
)
def test_a_bad_drive_ends_with_1_and_says_where(start, behaviour, words):
    run = start(*FAKE, "--launch-arg", f"behaviour:={behaviour}")
    assert run.wait() == 1
    assert words in run.last_line and "simulated time" in run.last_line


@pytest.mark.parametrize(
    ("behaviour", "options", "words"),
    [
        (
            "blind",
            ("--fast", "--startup-timeout", "15"),
            "the follower (nobody subscribes to /camera/rgb/image_raw) was not there within 15 s",
        ),
        (
            "fails",
            (),
            "the follower 05follower_proporation.py (process follower-2) died (exit code 3)",
        ),
        ("pauses", ("--stuck-timeout", "12"), "simulated time has stood still at 6.7 s"),
        ("hangs", ("--stuck-timeout", "12"), "the simulator is paused or hangs"),
    ],
)
def test_what_cannot_run_ends_with_2_and_says_why(start, behaviour, options, words):
    run = start(*FAKE, "--launch-arg", f"behaviour:={behaviour}", *options)
    assert run.wait() == 2
    assert words in run.last_line


@pytest.mark.parametrize(
    ("pattern", "words"),
    [
        ("fake_follower", "the follower 05follower_proporation.py"),
        ("fake_simulator", "the simulator"),
        ("rosmaster", "roscore"),
        (r"bin/roscore", "roscore"),
        (r"bin/roslaunch", "roslaunch"),
    ],
)
def test_a_killed_part_ends_the_run_with_2(start, pattern, words):
    run = start(*FAKE, "--launch-arg", "factor:=3")
    run.wait_for_driving()
    os.kill(run.pid_of(pattern), signal.SIGKILL)
    assert run.wait() == 2
    assert run.last_line.startswith(f"course_run: {words}")
    assert "SIGKILL" in run.last_line and "at simulated time" in run.last_line
    assert "Traceback" not in run.output
    assert "log: " in run.last_line


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_all_within_three_seconds(start, number):
    run = start(*FAKE, "--launch-arg", "factor:=3")
    run.wait_for_driving()
    began = time.monotonic()
    os.kill(run.process.pid, number)
    assert run.wait() == 130
    assert time.monotonic() - began < end_time()
    assert json.loads((run.out / "report.json").read_text())["why"] == "interrupted"


def test_ctrl_c_while_starting_leaves_nothing(start):
    run = start(*FAKE)
    wait_until(lambda: left_running(run.out), LIMIT, "roscore starts")
    began = time.monotonic()
    os.kill(run.process.pid, signal.SIGINT)
    assert run.wait() == 130
    assert time.monotonic() - began < end_time()


def test_even_a_killed_run_leaves_nothing(start):
    run = start(*FAKE, "--launch-arg", "factor:=3")
    run.wait_for_driving()
    os.kill(run.process.pid, signal.SIGKILL)
    run.process.wait()
    wait_until(lambda: not left_running(run.out), LIMIT, "all processes have ended")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--laps", "0"), "--laps (LAPS=) must be a whole number, 1 to 999999; got '0'"),
        (("--laps", "-1"), "got '-1'"),
        (("--laps", "abc"), "got 'abc'"),
        (("--laps", "1.5"), "got '1.5'"),
        (("--duration", "0"), "--duration (DURATION=) must be seconds of simulated time"),
        (("--duration", "nan"), "got 'nan'"),
        (("--follower", "08nothing.py"), "there are: 05follower_proporation.py, 06follower_pid.py"),
        (("--launch-arg", "x_pos=1"), "--launch-arg must look like name:=value, got 'x_pos=1'"),
        (("--track", "nowhere.yaml"), "nowhere.yaml: No such file or directory"),
        (("--camera", "640"), "--camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480"),
        (("--camera", "0x480"), "got '0x480'"),
        (("--camera", "640x480.5"), "got '640x480.5'"),
        (("--seed", "-1"), "--seed (SEED=) must be a whole number, 0 to 999999999; got '-1'"),
        (("--seed", "abc"), "got 'abc'"),
        (("--quick",), "unrecognized arguments: --quick"),
    ],
)
def test_a_mistyped_command_is_one_line_and_2(tmp_path, capsys, arguments, words):
    assert run_program_of(CourseRun, [*arguments, "--out", str(tmp_path)]) == NOT_RUN
    (line,) = capsys.readouterr().err.splitlines()
    assert words in line


def test_the_table_follows_the_locale(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    run = {"laps_closed": 2, "distance_m": 28.4, "outcome": "time is up"}
    monkeypatch.setenv("LANGUAGE", "en")
    english = followers_table({"a.py": run}, "a.py").split("\n")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    chinese = followers_table({"a.py": run}, "a.py").split("\n")
    assert english[0].split("  ")[1] == "follower" and english[1].endswith("  time is up")
    assert chinese[0].split() == ("程序 圈数 每圈 s m RMS cm 最大 cm 帧数 丢帧 真实时间倍数"
                                  " 结果").split()
    assert chinese[1].endswith("  时间到")
    at = [line.index(word) for line, word in zip(chinese, ("结果", "时间到"), strict=True)]
    assert width(chinese[0][:at[0]]) == width(chinese[1][:at[1]])
