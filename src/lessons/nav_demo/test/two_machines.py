"""Two machines on one: network namespaces, where this user may make them.

The first runs the master. Between them is a cable (a veth pair), or a slow one (slow_cable.py).
"""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
SIMULATOR, LAPTOP = "10.77.0.1", "10.77.0.2"
MASTER = f"http://{SIMULATOR}:11311"
NAMES = [f"nav{os.getpid()}{letter}" for letter in "ab"]
ENDING = 20.0  # s for a launch file to end its nodes


def ip(*words):
    """Raises CalledProcessError where that may not be, OSError where there is no such command."""
    return subprocess.run(["ip", *words], capture_output=True, text=True, check=True, timeout=20)


def command(namespace, *words, **settings):
    """What is run there, with these ROS settings and no others: arguments for Popen and run."""
    kept = {name: value for name, value in os.environ.items() if name not in
            ("ROS_HOSTNAME", "ROS_IP", "ROS_MASTER_URI")}
    path = f"{PACKAGE / 'src'}:{kept.get('PYTHONPATH', '')}"
    return {"args": ["ip", "netns", "exec", namespace, *words],
            "env": {**kept, "PYTHONPATH": path, "ROS_MASTER_URI": MASTER, **settings},
            "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}


@contextmanager
def machines():
    """Two namespaces of NAMES, each with its lo; skips the test where they cannot be made."""
    try:
        for name in NAMES:
            ip("netns", "add", name)
            ip("-n", name, "link", "set", "lo", "up")
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this user may not make network namespaces")
    try:
        yield
    finally:
        for name in NAMES:
            ip("netns", "del", name)


@contextmanager
def running():
    """Gives a function that starts a program in a namespace; all of them end with the context.

    A program without an `output`, an open file, has a pipe that is not read.
    """
    started = []

    def start(namespace, *words, output=subprocess.PIPE, **settings):
        how = command(namespace, *words, **settings) | {"stdout": output}
        started.append(subprocess.Popen(**how, start_new_session=True))
        return started[-1]

    try:
        yield start
    finally:
        for process in reversed(started):
            process.send_signal(signal.SIGINT)
            try:
                process.wait(ENDING)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def connect():
    """A cable."""
    ip("link", "add", NAMES[0], "netns", NAMES[0], "type", "veth",
       "peer", "name", NAMES[1], "netns", NAMES[1])
    give_addresses(*NAMES)


def give_addresses(*devices):
    """SIMULATOR's to the first machine's device, LAPTOP's to the second's; both are up then."""
    for name, device, address in zip(NAMES, devices, (SIMULATOR, LAPTOP)):
        ip("-n", name, "addr", "add", f"{address}/24", "dev", device)
        ip("-n", name, "link", "set", device, "up")


def check(**settings):
    """Exit code and lines of check_network on the laptop."""
    words = (sys.executable, str(PACKAGE / "scripts" / "check_network"))
    done = subprocess.run(**command(NAMES[1], *words, **settings), timeout=60)
    return done.returncode, done.stdout
