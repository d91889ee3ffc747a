"""The simulator on one machine, navigation on another: 20 ms apart, one packet in 100 lost.

About 60 s. Network namespaces and tun devices, where this user may make them.
"""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from two_machines import (
    LAPTOP,
    NAMES,
    SIMULATOR,
    check,
    command,
    give_addresses,
    machines,
    running,
)

pytestmark = pytest.mark.processes
DELAY, LOSS, SEED = 0.02, 0.01, 7  # s, share, each way
START, GOAL, BEYOND = (-2.0, -0.5), (-0.55, 0.55), 0.15  # m; the goal's tolerance and amcl's
SIMULATOR_UP, NAVIGATION_UP, DRIVEN = 90.0, 90.0, 100.0  # s, wall
THERE, HERE = {"ROS_HOSTNAME": SIMULATOR}, {"ROS_HOSTNAME": LAPTOP}


@pytest.fixture
def cable():
    """The machines, and the process that carries packets between them."""
    with machines():
        carrier = slow_cable()
        try:
            give_addresses("slow", "slow")
            yield carrier
        finally:
            carrier.kill()
            carrier.wait()


@pytest.fixture
def start(cable, tmp_path):
    """Starts launch files on the machines; their output goes to tmp_path."""
    with running() as run:
        def start(namespace, *words, **settings):
            with (tmp_path / f"{words[2]}.log").open("w") as log:
                run(namespace, *words, output=log, TURTLEBOT3_MODEL="waffle", **settings)

        yield start


def slow_cable():
    """It carries; skips the test where there are no tun devices."""
    script = Path(__file__).with_name("slow_cable.py")
    carrier = subprocess.Popen([sys.executable, script, "slow", str(DELAY), str(LOSS), str(SEED),
                                *NAMES], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if carrier.stdout.readline() != "ready\n":
        pytest.skip(f"no tun devices here: {carrier.stderr.read().splitlines()[-1]}")
    return carrier


def ask(namespace, *words, limit=60.0, **settings):
    """Exit code and output of a command there."""
    done = subprocess.run(**command(namespace, *words, **settings), timeout=limit)
    return done.returncode, done.stdout


def wait_until(condition, what, limit):
    end = time.monotonic() + limit
    while not (answer := condition()):
        assert time.monotonic() < end, f"not within {limit} s: {what}"
        time.sleep(0.5)
    return answer


def place():
    """(x, y), m, of the robot by the simulator's own word."""
    _, shown = ask(NAMES[0], "rosservice", "call", "/gazebo/get_model_state",
                   "{model_name: turtlebot3_waffle}", **THERE)
    state = yaml.safe_load(shown)
    return np.array([state["pose"]["position"][axis] for axis in "xy"])


def test_a_goal_is_reached(cable, start):
    start(NAMES[0], "roslaunch", "turtlebot3_gazebo", "turtlebot3_world.launch", "gui:=false",
          **THERE)
    shown = wait_until(lambda: (found := check(**HERE))[0] == 0 and found[1],
                       "check_network finds nothing wrong", SIMULATOR_UP)
    calls = float(re.search(r"a call takes ([\d.]+) ms", shown)[1])
    assert 2 * DELAY * 1e3 <= calls < 2000, shown  # a busy machine adds to it

    start(NAMES[1], "roslaunch", "turtlebot3_navigation", "turtlebot3_navigation.launch",
          "open_rviz:=false", f"initial_pose_x:={START[0]}", f"initial_pose_y:={START[1]}", **HERE)
    wait_until(lambda: "/move_base/result" in ask(NAMES[1], "rostopic", "list", **HERE)[1],
               "move_base", NAVIGATION_UP)
    np.testing.assert_allclose(place(), START, atol=0.02)
    code, shown = ask(NAMES[1], "rosrun", "nav_demo", "send_goal.py", *map(str, GOAL), "90",
                      limit=DRIVEN, **HERE)
    assert code == 0 and "Goal reached." in shown, shown
    assert np.hypot(*(place() - GOAL)) < BEYOND

    cable.send_signal(signal.SIGUSR1)
    counts = json.loads(cable.stdout.readline())
    share = counts["lost"] / (counts["carried"] + counts["lost"])
    assert share == pytest.approx(LOSS, rel=0.5), counts
