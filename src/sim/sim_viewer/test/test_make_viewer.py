"""`make viewer`: course and page come up together, and Ctrl-C ends both.

runs alone: the verbs know only the usual master, which other tests take while it is free.
"""

import os
import re
import signal
import socket
import subprocess
import time
import urllib.request
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
ROOT = Path(__file__).resolve().parents[4]
LIMIT = 90.0  # s, until the page serves
END_LIMIT = 20.0  # s, after Ctrl-C


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


@pytest.fixture
def viewer(tmp_path):
    """The verb, and the file with what it prints."""
    log = tmp_path / "output.txt"
    with log.open("wb") as output:
        process = subprocess.Popen(["make", "viewer", "CONTROL=1", f"PORT={free_port()}"],
                                   cwd=ROOT, stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
    yield process, log
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def address_in(log: Path, process) -> str:
    """The page's address, once it is printed."""
    until = time.monotonic() + LIMIT
    while time.monotonic() < until:
        if found := re.search(r"viewer: (http://\S+)", log.read_text()):
            return found[1]
        assert process.poll() is None, log.read_text()
        time.sleep(0.2)
    raise AssertionError(f"no address within {LIMIT} s: {log.read_text()}")


def test_course_and_page_come_and_go_together(viewer):
    process, log = viewer
    with urllib.request.urlopen(address_in(log, process), timeout=10) as page:
        assert page.status == 200
        assert b"<script" in page.read()
    os.killpg(process.pid, signal.SIGINT)  # as a terminal's Ctrl-C: to all of them
    process.wait(END_LIMIT)
    assert "Traceback" not in log.read_text()
