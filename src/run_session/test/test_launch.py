"""When roscore is up, that simulated time goes on, and that a full disk is named."""

import errno
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from run_session import launch
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.master import free_port, is_up
from run_session.processes import Family

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def master():
    """A master that has these parameters, and its address."""
    server = SimpleXMLRPCServer(("localhost", 0), logRequests=False)
    parameters = set()
    server.register_function(lambda _caller: (1, "", 4711), "getPid")
    server.register_function(lambda _caller, key: (1, key, key in parameters), "hasParam")
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield parameters, f"http://localhost:{server.server_address[1]}"
    server.shutdown()
    thread.join()
    server.server_close()


def test_a_master_whose_roscore_has_not_named_the_run_is_not_up_yet(master):
    parameters, address = master
    assert not is_up(address)
    parameters.add("/run_id")
    assert is_up(address)


def test_where_nobody_listens_nothing_is_up():
    assert not is_up(f"http://localhost:{free_port()}")


def test_time_that_stands_still_ends_the_run(tmp_path):
    with Family() as family:
        launched = Launched(family, tmp_path / "log")
        launched.start("course", ["sleep", "100"])
        for now in (1.0, 1.0, 2.0):
            launched.check_time(now, 60.0)
        until = time.monotonic() + 60.0
        with pytest.raises(RunError, match=r"stood still at 2\.0 s for"):
            while time.monotonic() < until:
                launched.check_time(2.0, 0.05)


def test_the_logs_are_in_english_whatever_the_terminal_speaks(tmp_path, monkeypatch):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    said = "from terminal_language import translated; print(translated('true or false'))"
    with Family() as family:
        launched = Launched(family, tmp_path / "log")
        launched.run("course", [sys.executable, "-c", said], 30)
    assert (tmp_path / "log/course.log").read_text() == "true or false\n"


def test_a_home_that_is_full_is_not_written_to(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", "/proc/none")  # where even root can write nothing
    monkeypatch.setenv("ROS_HOME", "/proc/none")
    monkeypatch.setenv("ROS_MASTER_URI", "")
    with Family() as family:
        launched = Launched(family, tmp_path / "log")
        launched.start_roscore()
        assert is_up(launched.master_uri)
        assert os.environ["ROS_HOME"] == str(tmp_path / "log")  # this process's nodes write, too


@pytest.mark.parametrize("joined", [False, True])
def test_a_master_that_others_join_is_held_until_it_has_a_simulator(tmp_path, monkeypatch, joined):
    """Else `make viewer`, started in the same second, would find none, and start its own there."""
    found = []
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setattr(launch, "may_simulate", lambda _uri: bool(found))
    with Family() as family:
        launched = Launched(family, tmp_path / "log", joined=joined)
        launched.start_roscore()
        waits = "flock() { if [ $1 = -w ]; then echo held; else command flock $*; fi; }"
        command = ["bash", "-c", f". {ROOT}/scripts/common.sh; {waits}; take_turn"]
        assert subprocess.run(command, capture_output=True, text=True,
                              check=True).stdout == ("held\n" if joined else "")
        found.append("/gazebo")
        launched.check(None)
        assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == ""


@pytest.mark.parametrize("command", [
    ["false"], ["sh", "-c", "echo '[a-1] process has died [pid 1, exit code 1'; exec sleep 100"]])
def test_a_program_that_ends_as_the_disk_is_full_names_the_disk(tmp_path, monkeypatch, command):
    def full(folder):
        raise OSError(errno.ENOSPC, "No space left on device", str(folder))

    monkeypatch.setattr(launch, "check_space", full)
    with Family() as family:
        launched = Launched(family, tmp_path / "log")
        launched.start("course", command)
        with pytest.raises(OSError, match=r"No space left .*log"):
            launched.wait_for("the course", lambda: False, 60.0)
