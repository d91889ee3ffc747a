"""check_network between two machines: network namespaces, where this user may make them."""

import time

import pytest
from two_machines import LAPTOP, NAMES, SIMULATOR, check, connect, machines, running

pytestmark = pytest.mark.processes


@pytest.fixture(scope="module")
def start():
    """Two of them, with a cable between and a master on the first; starts programs there."""
    with machines(), running() as start:
        connect()
        start(NAMES[0], "rosmaster", "--core", "-p", "11311", ROS_IP=SIMULATOR)
        yield start


def wait_for(words, **settings):
    end = time.monotonic() + 60
    while time.monotonic() < end:
        shown = check(**settings)
        if words in shown[1]:
            return shown
    raise AssertionError(shown)


def test_right_settings_then_each_wrong_one(start):
    code, _ = wait_for("nothing is wrong", ROS_IP=LAPTOP)
    assert code == 0
    code, shown = check(ROS_HOSTNAME="localhost")
    assert code == 1 and "ROS_HOSTNAME is 'localhost'" in shown
    assert "the master on 10.77.0.1 cannot call this machine by 'localhost'" in shown
    assert f"export ROS_IP={LAPTOP}" in shown
    code, shown = check(ROS_IP=LAPTOP, ROS_MASTER_URI="http://10.77.0.9:11311")
    assert code == 1 and "no answer from 10.77.0.9:11311" in shown
    start(NAMES[0], "rostopic", "pub", "-r", "1", "/chatter", "std_msgs/String", "hi",
          ROS_IP="127.0.0.1")
    code, shown = wait_for("registered as '127.0.0.1', which leads each machine", ROS_IP=LAPTOP)
    assert code == 1
