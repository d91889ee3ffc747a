"""Nodes in a terminal, before there is a master, or with one that does not answer."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
SOURCES = Path(__file__).resolve().parents[1] / "src"


@pytest.mark.parametrize("script, words", [
    ("car_control/scripts/motor_control.py", []),  # chaos: race, seed 506
    ("car_control/scripts/lane_follow.py", []),
    ("lessons/lane_keeping/scripts/lane_keeping_node.py", []),  # chaos: lane_empty, seed 2009
    ("lessons/nav_demo/scripts/send_goal.py", ["1", "1"])])
def test_ctrl_c_ends_a_node_without_a_traceback(script, words, tmp_path):
    """About 1 s each."""
    with socket.socket() as nobody:
        nobody.bind(("localhost", 0))  # and does not listen
        uri = f"http://localhost:{nobody.getsockname()[1]}"
        node = subprocess.Popen(
            [sys.executable, SOURCES / script, *words], stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True,
            # As in a terminal: what a script runs in the background does not hear Ctrl-C.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
            env=os.environ | {"ROS_MASTER_URI": uri, "ROS_LOG_DIR": str(tmp_path),
                              "PYTHONUNBUFFERED": "1"})
        try:
            assert "No ROS master at" in node.stdout.readline()
            node.send_signal(signal.SIGINT)
            said, _ = node.communicate(timeout=30)
        finally:
            node.kill()
    assert (said, node.returncode) == ("", 130)


def test_ctrl_c_ends_a_node_whose_master_hangs(tmp_path):
    """rospy waits for it in the main thread, for ever. About 4 s."""
    with socket.create_server(("localhost", 0)) as master:  # nobody ever answers
        node = subprocess.Popen(
            [sys.executable, "-c", "from car_control.node import Ending; import rospy; Ending();"
             "print('begins', flush=True); rospy.get_param('/any')"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
            env=os.environ | {"ROS_MASTER_URI": f"http://localhost:{master.getsockname()[1]}",
                              "ROS_LOG_DIR": str(tmp_path)})
        try:
            assert node.stdout.readline() == "begins\n"
            node.send_signal(signal.SIGINT)
            said, _ = node.communicate(timeout=30)
        finally:
            node.kill()
    assert (said, node.returncode) == ("", 130)
