"""Runs commands with a time limit, and leaves none of their processes running."""

from __future__ import annotations

import os
import signal
import subprocess
import time
import uuid
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MARK = "RUN_TESTS_MARK"  # environment variable by which a test's processes are known
GRACE = 5.0  # s that a test's processes have to end after it
STOP = 15.0  # s that rostest has to end its nodes when interrupted
LOW_PRIORITY = 5  # nice
Watch = Callable[[Path], None]

stopping = False  # set by a signal: running tests are cut short, no new ones begin


def stop(_signal: int, _frame: object) -> None:
    """Handler of the signals that end the run."""
    global stopping
    stopping = True


def processes_marked(mark: str) -> list[int]:
    """Process ids whose environment carries the mark, whatever session or parent they have."""
    needle = f"{MARK}={mark}".encode()
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if needle in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
        except OSError:
            continue  # gone by now, or another user's
    return found


def command_line(pid: int) -> str:
    """A process's command line, if it can still be read."""
    try:
        words = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
        return b" ".join(words).decode(errors="replace").strip()
    except OSError:
        return f"process {pid}"


def kill_left_over(mark: str, grace: float) -> list[str]:
    """Kill processes that still run after `grace` seconds; returns their command lines."""
    limit = time.monotonic() + grace
    while (left := processes_marked(mark)) and time.monotonic() < limit:
        time.sleep(0.1)
    commands = [command_line(pid) for pid in left]
    while left:
        for pid in left:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.05)
        left = processes_marked(mark)
    return commands


def _give_way(pid: int) -> None:
    """Lowers a process's priority, also that of its session."""
    os.setpriority(os.PRIO_PROCESS, pid, os.nice(0) + LOW_PRIORITY)  # 19 at most
    for _ in range(10):
        try:  # with autogroup scheduling a session has a priority of its own
            Path(f"/proc/{pid}/autogroup").write_text(str(LOW_PRIORITY))
            return
        except BlockingIOError:
            time.sleep(0.1)  # an ordinary user's next change
        except OSError:
            return


def run_marked(command: list[str], log: Path, limit: float, watch: Watch,
               low_priority: bool = False) -> tuple[int, list[str]]:
    """Exit code (124 after `limit` seconds) and processes left running; `watch` gets the log."""
    mark = uuid.uuid4().hex
    ros_home = str(log.parent / "ros")  # tests write nothing to the user's ~/.ros
    env = dict(os.environ, **{MARK: mark}, ROS_HOME=ros_home, ROS_LOG_DIR=ros_home)
    end = time.monotonic() + limit
    with log.open("wb") as output:
        child = subprocess.Popen(command, cwd=ROOT, env=env, stdin=subprocess.DEVNULL,
                                 stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
        if low_priority:
            _give_way(child.pid)
        while child.poll() is None and time.monotonic() < end and not stopping:
            time.sleep(0.05)
            watch(log)
        cut_short = child.poll() is None
        if cut_short:
            child.send_signal(signal.SIGINT)
            try:
                child.wait(2.0 if stopping else STOP)
            except subprocess.TimeoutExpired:
                pass
        left = kill_left_over(mark, 0.0 if cut_short else GRACE)
        return (124 if cut_short else child.wait()), left


def unseen(_log: Path) -> None:
    """A watch that ignores the log."""
