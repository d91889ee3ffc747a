"""roslaunch at a SIGHUP, by hand and with nohup."""

import os
import signal
import socket
import subprocess
import time

import pytest

pytestmark = pytest.mark.processes

LIMIT = 60.0  # s
GOES_ON = 3.0  # s


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return str(probe.getsockname()[1])


@pytest.fixture(params=[(), ("nohup",)], ids=["by_hand", "nohup"])
def nohup(request):
    return request.param


@pytest.fixture
def launched(nohup, tmp_path):
    """A roslaunch whose node has started."""
    begun, launch = tmp_path / "begun", tmp_path / "one.launch"
    prefix = f"sh -c 'touch {begun}; exec sleep 300'"
    launch.write_text(f'<launch><node name="a" pkg="rosout" type="rosout" '
                      f'launch-prefix="{prefix}"/></launch>', encoding="utf-8")
    process = subprocess.Popen(
        [*nohup, "roslaunch", "-p", free_port(), launch], stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        env=os.environ | {"ROS_HOSTNAME": "localhost"})
    try:
        end = time.monotonic() + LIMIT
        while not begun.exists() and time.monotonic() < end:
            time.sleep(0.05)
        yield process
    finally:
        process.terminate()
        process.wait(LIMIT)


def test_only_with_nohup_it_outlives_its_terminal(launched, nohup):
    launched.send_signal(signal.SIGHUP)
    if nohup:
        with pytest.raises(subprocess.TimeoutExpired):
            launched.wait(GOES_ON)
    else:
        launched.wait(LIMIT)
