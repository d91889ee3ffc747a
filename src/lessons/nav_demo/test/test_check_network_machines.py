"""check_network between two machines: network namespaces, where this user may make them."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
PACKAGE = Path(__file__).resolve().parents[1]
SIMULATOR, LAPTOP = "10.77.0.1", "10.77.0.2"
MASTER = f"http://{SIMULATOR}:11311"
NAMES = [f"nav{os.getpid()}{letter}" for letter in "ab"]


def ip(*words):
    return subprocess.run(["ip", *words], capture_output=True, text=True, check=True, timeout=20)


def command(namespace, *words, **settings):
    """What is run there, with these ROS settings and no others."""
    kept = {name: value for name, value in os.environ.items() if name not in
            ("ROS_HOSTNAME", "ROS_IP", "ROS_MASTER_URI")}
    path = f"{PACKAGE / 'src'}:{kept.get('PYTHONPATH', '')}"
    return {"args": ["ip", "netns", "exec", namespace, *words],
            "env": {**kept, "PYTHONPATH": path, "ROS_MASTER_URI": MASTER, **settings},
            "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}


@pytest.fixture(scope="module")
def machines():
    """Two of them, with a cable between and a master on the first."""
    try:
        for name in NAMES:
            ip("netns", "add", name)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this user may not make network namespaces")
    started = []
    try:
        ip("link", "add", NAMES[0], "netns", NAMES[0], "type", "veth",
           "peer", "name", NAMES[1], "netns", NAMES[1])
        for name, address in zip(NAMES, (SIMULATOR, LAPTOP)):
            ip("-n", name, "addr", "add", f"{address}/24", "dev", name)
            ip("-n", name, "link", "set", "lo", "up")
            ip("-n", name, "link", "set", name, "up")

        def start(namespace, *words, **settings):
            started.append(subprocess.Popen(**command(namespace, *words, **settings)))
            return started[-1]

        start(NAMES[0], "rosmaster", "--core", "-p", "11311", ROS_IP=SIMULATOR)
        yield start
    finally:
        for process in started:
            process.terminate()
            process.wait(10)
        for name in NAMES:
            ip("netns", "del", name)


def check(**settings):
    """Exit code and lines on the laptop."""
    words = (sys.executable, str(PACKAGE / "scripts" / "check_network"))
    done = subprocess.run(**command(NAMES[1], *words, **settings), timeout=30)
    return done.returncode, done.stdout


def wait_for(words, **settings):
    end = time.monotonic() + 20
    while time.monotonic() < end:
        shown = check(**settings)
        if words in shown[1]:
            return shown
    raise AssertionError(shown)


def test_right_settings_then_each_wrong_one(machines):
    code, _ = wait_for("nothing is wrong", ROS_IP=LAPTOP)
    assert code == 0
    code, shown = check(ROS_HOSTNAME="localhost")
    assert code == 1 and "ROS_HOSTNAME is 'localhost'" in shown
    assert "the master on 10.77.0.1 cannot call this machine by 'localhost'" in shown
    assert f"export ROS_IP={LAPTOP}" in shown
    code, shown = check(ROS_IP=LAPTOP, ROS_MASTER_URI="http://10.77.0.9:11311")
    assert code == 1 and "10.77.0.9:11311 does not answer" in shown
    machines(NAMES[0], "rostopic", "pub", "-r", "1", "/chatter", "std_msgs/String", "hi",
             ROS_IP="127.0.0.1")
    code, shown = wait_for("registered as '127.0.0.1', which leads each machine", ROS_IP=LAPTOP)
    assert code == 1
