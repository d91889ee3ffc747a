"""Runs in lockstep with the real simulator are gone back into, and driven on from there."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from replay_seeds import SCRIPTS, drive, go_back

from bullet_sim.formats.run_log import read_run_log
from evaluation.replay import NEW

pytestmark = pytest.mark.processes
LIMIT = 300.0  # s, wall


@pytest.mark.timeout(2 * LIMIT)
@pytest.mark.parametrize(
    ("course", "seed"), [("course", 3), ("race", 0), ("lane", 25), ("avoid", 1)])
def test_the_state_at_an_image_is_the_runs(course, seed, tmp_path):
    path = drive(course, seed, tmp_path / "run", 5)
    log = read_run_log(path)
    assert log.whole
    said = go_back(path, "end", tmp_path / "replay")
    last = log.images[-1]
    assert f"image {len(log.images)} of {len(log.images)}, {log.time_of(last):.3f} s: the state " \
        f"is the run's ({last.data.hex()})" in said


class Replay:
    """make replay, in a terminal."""

    def __init__(self, *words):
        self.process = subprocess.Popen(
            [sys.executable, SCRIPTS / "replay.py", *map(str, words)], text=True,
            env=os.environ | {"PYTHONUNBUFFERED": "1"}, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.lines, self._read = [], 0
        threading.Thread(target=self._take, daemon=True).start()

    def _take(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip())

    def type(self, word):
        self._read = len(self.lines)
        self.process.stdin.write(f"{word}\n")
        self.process.stdin.flush()

    def wait_for(self, text, since=None):
        """A line with it of those since the last command, or line `since`."""
        since = self._read if since is None else since
        until = time.monotonic() + LIMIT
        while True:
            for line in self.lines[since:]:
                if text in line:
                    return line
            assert self.process.poll() is None and time.monotonic() < until, self.lines
            time.sleep(0.1)

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.wait(60)


@pytest.mark.timeout(2 * LIMIT)
def test_who_drives_on_from_an_image_with_the_same_program_drives_the_same(tmp_path):
    path = drive("course", 3, tmp_path / "run", 5)
    first = read_run_log(path)
    replay = Replay("--run", path, "--at", "2.0", "--out", tmp_path / "replay")
    follower = None
    try:
        replay.wait_for("image 60 of ")
        replay.type("n")
        replay.wait_for("image 61 of ")
        replay.type("p")
        replay.wait_for("image 60 of ")
        replay.type("lost")
        replay.wait_for("the log has no mark 'lost'")
        uri = replay.wait_for(" ROS_MASTER_URI=", 0).partition("ROS_MASTER_URI=")[2]
        unpause, said = ["rosservice", "call", "/gazebo/unpause_physics"], ""
        joined = os.environ | {"ROS_MASTER_URI": uri}
        while "the world goes on by itself; p or a time goes back" not in said:  # the page's button
            subprocess.run(unpause, env=joined, check=True, timeout=60)
            replay.type("n")
            said = replay.wait_for(" the ")
        replay.type("image:62")  # ahead of it
        replay.wait_for("image 62 of ")
        replay.type("2.0")
        replay.wait_for("image 60 of ")
        replay.type("go")
        said = replay.wait_for("no program sends /cmd_vel: in another terminal, start the ")
        assert "rosrun learning_topic 07follower_ground.py; then drive on again (go)" in said
        follower = subprocess.Popen(["rosrun", "learning_topic", "07follower_ground.py"],
                                    env=joined)
        said = ""
        while "the world goes on" not in said:
            replay.type("go")
            said = replay.wait_for("go")
        second = tmp_path / "replay" / "run.log.gz"
        until = time.monotonic() + LIMIT
        while len(read_run_log(second.with_name(NEW)).images) < 100:
            assert time.monotonic() < until
            time.sleep(0.2)
        replay.type("q")
        replay.process.wait(60)
    finally:
        replay.end()
        if follower is not None:
            follower.terminate()
            follower.wait(60)
    driven_on = read_run_log(second)
    assert not [event for event in driven_on.events if event.kind == "lacks"]
    images = driven_on.images
    count = min(len(images), len(first.images))
    assert count >= 100 and images[:count] == first.images[:count]
    # To look at it again, or at another run, is not to lose it.
    for run in (second, path):
        assert "image 30 of " in go_back(run, "1.0", second.parent)
    assert read_run_log(second).images == images
    assert sorted(each.name for each in second.parent.iterdir()) == ["log", "run.log.gz"]
