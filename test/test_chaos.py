"""What `make chaos` looks at, and what its command refuses; its rounds take minutes each."""

import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pytest

pytestmark = pytest.mark.processes
CHAOS = Path(__file__).parent / "chaos"
TRACEBACK = "Traceback (most recent call last):\n"
TELLS_TIME = """
import sys, time
for _ in sys.stdin:
    print(time.time(), time.monotonic(), flush=True)
"""


@pytest.fixture(scope="module")
def chaos(modules):
    return modules("chaos", "checks", "clock", "course", "members", "restarts", "rounds", "states",
                   "terminals")


def test_half_a_file_is_noticed(chaos, tmp_path):
    picture = cv2.imencode(".png", np.zeros((50, 50, 3), np.uint8))[1].tobytes()
    for name, content in (("path.png", picture), ("report.json", b"{}\n"), ("log/a.tmp", b"")):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(content)
    assert list(chaos["checks"].half_files(tmp_path)) == []
    for name, content in (("path.png", picture[:-4]), ("report.json", b"{"), ("run.mp4", b"moov"),
                          ("report.json.tmp", b"{}")):
        (tmp_path / name).write_bytes(content)
    assert list(chaos["checks"].half_files(tmp_path)) == [
        f"{name} is not whole" for name in ("path.png", "report.json", "report.json.tmp",
                                            "run.mp4")]


@pytest.mark.parametrize("said, code, faults", [
    ("course_run: the simulator died\n", 2, 0), ("", 2, 1), ("drives\n", 0, 0),
    ("course_run: no film: ffmpeg\ncourse_run: died\n", 2, 0),
    ("course_run: one\ncourse_run: two\n", 2, 1), (f"{TRACEBACK}ValueError\n", 1, 1),
    (f"{TRACEBACK}KeyboardInterrupt\n", 130, 1)])
def test_who_ends_early_says_one_line(chaos, said, code, faults):
    assert len(list(chaos["checks"].wrong_words(said, code))) == faults


@pytest.mark.parametrize("said, faults", [
    (f"{TRACEBACK}ValueError\n", 1), (f"{TRACEBACK}KeyboardInterrupt\n", 0),
    (f"{TRACEBACK}  except KeyboardInterrupt:\nValueError\n", 1),
    (f"{TRACEBACK}KeyboardInterrupt: KeyboardInterrupt\n{TRACEBACK}ValueError\n", 1),
    (f"KeyboardInterrupt\n{TRACEBACK}ValueError\n", 1),
    (f"{TRACEBACK}rospy.exceptions.ROSInterruptException: shutdown\n", 1),
    (f'{TRACEBACK}  File "/usr/bin/rosversion", line 33\nBrokenPipeError\n', 0),
    (f"{TRACEBACK}KeyboardInterrupt\nException ignored in it\n{TRACEBACK}KeyboardInterrupt: ", 0),
    (f"Exception ignored in atexit\n{TRACEBACK}ValueError\n", 1),
    (f"{TRACEBACK}{TRACEBACK}KeyboardInterrupt\nKeyboardInterrupt\n", 0),  # of two at once
    (f'--- Logging error ---\nkilling on exit\n{TRACEBACK}  File "/usr/lib/python3.11/logging/'
     '__init__.py", line 1114, in emit\nOSError\n', 0),
    (f'{TRACEBACK}  File "/usr/lib/python3.11/logging/handlers.py", line 73\nOSError\n', 0),
    (f'{TRACEBACK}  File "/usr/lib/python3.11/logging/__init__.py", line 1\nValueError\n', 1),
    (f"{TRACEBACK}  File\nxmlrpc.client.Fault: <Fault 1>\n", 1),
    (f"{TRACEBACK}  File\npybullet.error: Not connected\n", 1),
    ("all is well\n", 0)])
def test_a_traceback_in_a_log_is_noticed(chaos, tmp_path, said, faults):
    (tmp_path / "roslaunch.log").write_text(said)
    assert len(list(chaos["checks"].wrong_logs(tmp_path))) == faults


def state(now, x, yaw=0.0):
    """A line of the simulator's."""
    turn = [0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)]
    return json.dumps({"time": now, "poses": {"car": [x, 0.0, 0.0, *turn]}})


@pytest.mark.parametrize("stop, until, fault", [
    (0.6, 9.0, False), (0.8, 9.0, True), (9.0, 9.0, True), (9.0, 0.6, False)])
def test_a_car_that_drives_on_is_noticed(chaos, tmp_path, stop, until, fault):
    """Its driver is gone at 1 s; it stands `stop` s later, the simulation ends `until` s later."""
    times = np.arange(0.0, 1.0 + min(until, 9.0), 0.04)
    lines = [state(now, min(now, 1.0 + stop) * 0.2) for now in times]
    path = tmp_path / "states"
    path.write_text("\n".join([*lines, '{"time": 3']), encoding="utf-8")
    seen = chaos["states"].places(path, "car")
    assert len(seen) == len(times)
    assert (chaos["states"].drives_on(seen, 1.0, 9.9) is not None) == fault
    assert chaos["states"].driven(seen) > 0.02


@pytest.mark.parametrize("place, fault", [
    (lambda now: (0.0, 0.1 * now), True), (lambda now: (0.0, 0.0), False),  # it turns; it stood
    (lambda now: (0.1 * max(0.0, now - 2.5), 0.0), True)])  # it stands, and sets off again
def test_a_car_that_turns_or_sets_off_again_is_noticed(chaos, tmp_path, place, fault):
    path = tmp_path / "states"
    path.write_text("".join(f"{state(now, *place(now))}\n" for now in np.arange(0.0, 9.0, 0.04)))
    seen = chaos["states"].places(path, "car")
    assert (chaos["states"].drives_on(seen, 1.0, 9.9) is not None) == fault


@pytest.mark.parametrize("name", ["course", "race", "lane_empty"])
def test_a_seed_is_a_round_and_every_fault_has_one(chaos, name):
    course, drawn = chaos["course"].COURSES[name], chaos["rounds"].drawn
    rounds = [drawn(course, seed) for seed in range(1, 201)]
    assert [each.title for each in rounds] == [drawn(course, seed).title for seed in range(1, 201)]
    faults = chaos["rounds"].faults_of(course.drivers)
    assert {each.fault.name for each in rounds} == {fault.name for fault in faults}


@pytest.fixture
def hands(chaos, tmp_path, monkeypatch):
    """Terminals in which shell lines are typed in place of ROS's commands."""
    made = chaos["terminals"].Terminals(chaos["course"].COURSES["course"], tmp_path, True)
    lines = {"roscore": "sleep 1000", "world": "exec sleep 1000", "follower": "echo 1; sleep 1000"}
    monkeypatch.setattr(made, "_command", lambda name: ["sh", "-c", lines[name]])
    monkeypatch.setattr(made, "_is_ready", lambda name: True)
    made.lines = lines
    yield made
    made.close(0.0)


def test_a_terminal_ends_by_ctrl_c_and_is_opened_again(chaos, hands):
    assert hands.start_usual(60.0) and list(hands.open) == ["roscore", "world", "follower"]
    assert not hands.ended("world", 0.0)
    hands.interrupt("roslaunch")  # in the world's terminal
    assert hands.ended("world", 60.0) and list(hands.open) == ["roscore", "follower"]
    hands.lines["world"] = "echo '[gazebo-1] process has died [pid 7, exit code -9, cmd x]'"
    assert hands.start_usual(60.0, last="world") and hands.open["world"].wait(60.0) == 0
    assert hands.dead_nodes() == {"gazebo"} and not hands.lives()
    assert sorted(path.name for path in hands.folder.glob("log/*.log")) == [
        "follower-0.log", "roscore-0.log", "world-0.log", "world-1.log"]


@pytest.mark.parametrize("said, faults", [
    ("no more pictures", []), ("one; echo two", ["follower ended by itself with 2 lines"])])
def test_a_survivor_that_ends_says_why_in_one_line(chaos, hands, said, faults):
    hands.lines["follower"] = f"echo it drives; read go < {hands.folder}/go; echo {said}"
    os.mkfifo(hands.folder / "go")
    assert hands.start_usual(60.0) and hands.wait_for(lambda: hands.said("follower"), 60.0)
    told = {name: len(hands.said(name)) for name in hands.open}
    (hands.folder / "go").write_text("\n")
    hands.open["follower"].wait(60.0)
    ended = chaos["restarts"].ended_by_themselves(hands, told, but="world")
    assert list(ended) == faults and list(hands.open) == ["roscore", "world"]


@pytest.mark.parametrize("name", ["course", "race", "lane_empty"])
def test_restarts_can_be_asked_for_alone(chaos, name):
    rounds = [chaos["rounds"].drawn(chaos["course"].COURSES[name], seed, "restart")
              for seed in range(1, 51)]
    assert all(each.fault.by_hand for each in rounds)
    assert {each.roscore for each in rounds if each.fault.victim == "simulator"} == {True, False}
    assert all(each.roscore for each in rounds if each.fault.victim in ("master", "roscore"))


def test_what_is_left_behind_is_named_and_ended(chaos, tmp_path):
    members = chaos["members"]
    left = subprocess.Popen(["sleep", "1000"], start_new_session=True,
                            env={**os.environ, members.MARK: str(tmp_path)})
    assert members.matching(str(tmp_path), "^sleep 1000$") in ([left.pid], [])  # not yet exec'd
    assert members.end_left_over(str(tmp_path), 0.2) == ["sleep 1000"]
    assert left.wait(60.0) == -9
    assert members.end_left_over(str(tmp_path), 0.0) == []


def test_the_clock_jumps_for_a_round_s_programs_alone(chaos, tmp_path):
    environment = os.environ | chaos["clock"].clock_environment(tmp_path)
    told = subprocess.Popen([sys.executable, "-c", TELLS_TIME], env=environment, text=True,
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    seen = []
    for ahead in (0.0, -7200.5, 30.0):
        chaos["clock"].set_clock(tmp_path, ahead)
        told.stdin.write("\n")
        told.stdin.flush()
        wall, monotonic = map(float, told.stdout.readline().split())
        seen.append((wall - time.time(), monotonic - time.monotonic()))
    told.communicate()
    assert [wall for wall, _ in seen] == pytest.approx([0.0, -7200.5, 30.0], abs=20.0)
    assert [monotonic for _, monotonic in seen] == pytest.approx([0.0] * 3, abs=20.0)


@pytest.mark.parametrize("words, said", [
    (["--rounds", "0"], "--rounds (ROUNDS=) must be a whole number, 1 to "),
    (["--seed", "x"], "--seed (SEED=) must be a whole number"), (["--loud"], "scripts/chaos.sh"),
    (["--course", "moon"], "no course 'moon' (COURSE=); there are: course, race, lane_empty"),
    (["--only", "flood"], "no fault begins with 'flood' (ONLY=); there are: kill follower, ")])
def test_a_mistake_is_one_line(words, said):
    done = subprocess.run([sys.executable, CHAOS / "chaos.py", *words], capture_output=True,
                          text=True, timeout=120)
    assert done.returncode == 2 and said in done.stderr and done.stderr.count("\n") == 1
