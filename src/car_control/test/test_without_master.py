"""Nodes in a terminal, before there is a master."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
SCRIPTS = Path(__file__).resolve().parents[1] / "scripts"


@pytest.mark.parametrize("script", ["motor_control.py", "lane_follow.py"])
def test_ctrl_c_while_there_is_no_master_is_no_traceback(script, tmp_path):
    """Chaos: race, seed 506, ends roscore and then the rest while it starts."""
    with socket.socket() as nobody:
        nobody.bind(("localhost", 0))  # and does not listen
        uri = f"http://localhost:{nobody.getsockname()[1]}"
        node = subprocess.Popen(
            [sys.executable, SCRIPTS / script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            # As in a terminal: what a script runs in the background does not hear Ctrl-C.
            text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
            env=os.environ | {"ROS_MASTER_URI": uri, "ROS_LOG_DIR": str(tmp_path),
                              "PYTHONUNBUFFERED": "1"})
        try:
            assert "Will keep trying" in node.stdout.readline()
            node.send_signal(signal.SIGINT)
            said, _ = node.communicate(timeout=30)
        finally:
            node.kill()
    assert (said, node.returncode) == ("", 130)
