"""A session ends what it has started, and half a drive is none."""

import errno
import io
import os
import signal
import threading
import time
from types import SimpleNamespace

import psutil
import pytest

from run_session.failure import RunError
from run_session.session import Session, StatusLine

pytestmark = pytest.mark.processes
# As course_run: told to end, it reports what it has seen.
DRIVE = """
import os, signal, time
def end(*_):
    open("report.json", "w").write("{}")
    raise SystemExit(1)
signal.signal(signal.SIGINT, end)
print("drives", os.getpid(), flush=True)
time.sleep(1000)
"""
STUBBORN = ["sh", "-c", "trap '' INT; echo started; while :; do sleep 0.1; done"]


def wait_for(path, text):
    until = time.monotonic() + 60.0
    while not (path.exists() and text in path.read_text()):
        assert time.monotonic() < until, f"no {text!r} in {path}"
        time.sleep(0.02)


@pytest.fixture
def type_ctrl_c():
    """Once that log says so; it counts also where the tests run in a shell's background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def type_later(log, text):
        wait_for(log, text)
        time.sleep(0.2)
        os.kill(os.getpid(), signal.SIGINT)

    yield lambda *said: threading.Thread(target=type_later, args=said).start()
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def drive(tmp_path, monkeypatch):
    """A session, and the command of a drive that goes on until it is told to end."""
    monkeypatch.chdir(tmp_path)
    with Session(tmp_path) as session:
        yield session, ["python3", "-c", DRIVE]


def test_a_run_in_a_network_of_its_own_takes_no_name_for_an_address(tmp_path):
    with Session(tmp_path) as session:
        alone = session.launched("car", alone=True, environment={"X": "1"})
    assert alone.master_uri == f"http://127.0.0.1:{alone.port}"
    assert alone._environment["X"] == "1"


def test_a_drive_that_takes_too_long_ends_and_leaves_no_report(drive, tmp_path):
    session, command = drive
    with pytest.raises(RunError, match="a lap: the drive did not end within 8 s"):
        session.drive(command, tmp_path, "a lap", 8.0)
    assert not psutil.pid_exists(int((tmp_path / "drive.log").read_text().split()[1]))
    assert not (tmp_path / "report.json").exists()


def test_an_interrupted_drive_leaves_no_report(drive, tmp_path, type_ctrl_c):
    session, command = drive
    with pytest.raises(KeyboardInterrupt):
        type_ctrl_c(tmp_path / "drive.log", "drives")
        session.drive(command, tmp_path, "a lap", 60.0)
    session.family.stop()
    assert not (tmp_path / "report.json").exists()


def test_a_drive_that_broke_off_leaves_no_report(tmp_path):
    breaks = f"open('{tmp_path}/report.json', 'w').write('{{}}'); raise SystemExit(2)"
    with Session(tmp_path) as session, pytest.raises(RunError, match="a lap: exit code 2"):
        session.drive(["python3", "-c", breaks], tmp_path, "a lap", 60.0)
    assert not (tmp_path / "report.json").exists()


def test_a_drive_that_could_not_say_why_for_a_full_disk_names_that(tmp_path, monkeypatch):
    full = SimpleNamespace(f_blocks=9, f_bavail=0, f_frsize=4096, f_files=0, f_favail=0)
    monkeypatch.setattr(os, "statvfs", lambda _folder: full)
    with Session(tmp_path) as session, pytest.raises(OSError, match=str(tmp_path)) as said:
        session.drive(["python3", "-c", "raise SystemExit(120)"], tmp_path, "a", 60.0)
    assert said.value.errno == errno.ENOSPC


def test_a_ctrl_c_while_processes_end_leaves_none(tmp_path, type_ctrl_c):
    session = Session(tmp_path)
    child = session.family.start("stubborn", STUBBORN, os.environ, tmp_path / "log")
    wait_for(tmp_path / "log", "started")
    with pytest.raises(KeyboardInterrupt), session:
        type_ctrl_c(tmp_path / "log", "started")
    assert child.process.poll() is not None


def test_a_progress_line_that_nobody_reads_is_as_ctrl_c():
    def write(_text):
        raise BrokenPipeError

    unread = io.StringIO()
    unread.write = write
    with pytest.raises(KeyboardInterrupt):
        StatusLine(unread).say("simulated 0.0 s")


def test_a_progress_line_is_in_the_terminal_s_language_and_fits(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    monkeypatch.setenv("COLUMNS", "12")
    screen = io.StringIO()
    screen.isatty = lambda: True
    StatusLine(screen).status("waiting for the simulator (service /gazebo/get_world_properties)")
    assert screen.getvalue() == "\r正在等待仿\x1b[K"
