"""The sandbox alone, without ROS: what hostile programs see, use and leave behind."""

import dataclasses
import errno
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import made_up
import psutil
import pytest
from marking.bubblewrap import Kind, available, namespace
from marking.rules import load_rules
from marking.submission_process import SubmissionProcess, exceptions

from run_session.failure import RunError

pytestmark = pytest.mark.processes
LIMIT = 60.0  # s, wall
LIMITS = dataclasses.replace(
    load_rules(Path(__file__).parents[1] / "config" / "marking.yaml").limits, memory_mb=600,
    disk_mb=16, output_mb=2)


@pytest.fixture(scope="module")
def kind() -> Kind:
    try:
        return available()
    except RunError as refused:
        pytest.skip(str(refused))


@pytest.fixture()
def boxed(kind, tmp_path):
    """Starts a program in a sandbox; afterwards nothing of it runs."""
    boxes = []

    def start(program: str) -> SubmissionProcess:
        folder = tmp_path / "submission"
        folder.mkdir()
        (folder / "main.py").write_text(program, encoding="utf-8")
        tmp_path.chmod(0o755)
        boxes.append(SubmissionProcess(kind, folder, Path("main.py"), LIMITS,
                         {"PATH": os.environ["PATH"]}, tmp_path / "output.txt"))
        return boxes[-1]

    yield start
    for box in boxes:
        box.end()
    until = time.monotonic() + LIMIT  # a busy machine needs a moment for a fork bomb's processes
    while living := [each for each in psutil.Process().children(recursive=True)
                     if each.status() != psutil.STATUS_ZOMBIE]:
        assert time.monotonic() < until, living
        time.sleep(0.05)


@pytest.mark.parametrize(("program", "says"), [
    ("def f():\n    import json\n    json.loads('')\n\nf()\n", "main.py, line 3: json.decoder."),
    ("print('File \"/x.py\", line 7')\nraise ValueError", "main.py, line 2: ValueError"),
    ("import traceback\ntry:\n    1 / 0\nexcept ArithmeticError:\n    traceback.print_exc()\n"
     "raise KeyError('x')\n", "main.py, line 6: KeyError: 'x'")])  # what ended it, not an earlier
def test_where_a_program_broke_off(boxed, program, says):
    reason = fault_of(boxed(program))
    assert reason.startswith(f"exception in {says}")
    assert reason.endswith("; the program ended (exit code 1)")


CALLBACK = """\x1b[31m[ERROR] [1796010545.129, 0.034]: bad callback: <bound method image>
Traceback (most recent call last):
  File "/usr/lib/python3/dist-packages/rospy/topics.py", line 750, in _invoke_callback
    cb(msg)
  File "/home/submission/my follower.py", line 61, in image
    gain = 1 / 0
           ~~^~~
{}: division by zero\x1b[0m
"""


def test_exceptions_in_callbacks_are_found_in_what_was_printed():
    printed = f"hello\n{CALLBACK.format('ZeroDivisionError')}{CALLBACK.format('MyFault')}"
    where = "exception in my follower.py, line 61: "
    assert exceptions(printed, "/home/submission") == [
        f"{where}ZeroDivisionError: division by zero", f"{where}MyFault: division by zero"]
    assert exceptions(printed, "/srv/other") == []


def test_a_program_that_only_reaches_its_end_is_told_what_is_missing(boxed):
    assert fault_of(boxed("x = 1")) == "the program ended (exit code 0); is rospy.spin() missing?"


@pytest.mark.parametrize(("user", "advice"), [
    (1000, r"allows this user no namespaces \(Operation not permitted\); as root it may be: "
           "sudo make mark SUBMISSIONS=DIR; in Docker give --privileged"),
    (0, r"allows root no namespaces \(Operation not permitted\); in Docker give --privileged")])
def test_a_refusal_says_what_would_allow_it(monkeypatch, user, advice):
    monkeypatch.setattr(os, "getuid", lambda: user)
    monkeypatch.setattr(shutil, "which", lambda name: name)
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: subprocess.CompletedProcess(
        [], 1, "", "Operation not permitted\n"))
    with pytest.raises(RunError, match=advice):
        available()


def fault_of(box: SubmissionProcess) -> str:
    until = time.monotonic() + LIMIT
    while not (fault := box.fault()):
        assert time.monotonic() < until, "it still runs"
        time.sleep(0.05)
    return "; ".join(filter(None, [box.exception(), fault]))


@pytest.mark.parametrize("student", [
    "looks_around", "much_output", "much_memory", "many_take_memory", "fills_disk", "kills_all",
    "fork_bomb", "crash_at_once", "missing_module", "python2", "tabs"])
def test_what_ends_is_said_in_one_line(boxed, student):
    program, says, *_ = made_up.PROGRAMS[student]
    fault = fault_of(boxed(program))
    assert says in fault
    assert "\n" not in fault


FIRST_THREAD_ENDS = """import ctypes, mmap, threading, time
def fill():
    time.sleep(0.5)
    shared = mmap.mmap(-1, 700_000_000)
    for _ in range(700):
        shared.write(bytes(1_000_000))
    time.sleep(1000)
threading.Thread(target=fill).start()
ctypes.CDLL(None).pthread_exit(None)
"""


def test_memory_counts_when_the_first_thread_has_ended(boxed):
    assert "it used more than 600 MB" in fault_of(boxed(FIRST_THREAD_ENDS))


@pytest.mark.parametrize("student", ["endless_import", "deaf_to_signals"])
def test_what_never_ends_is_ended_with_all_it_started(boxed, student):
    box = boxed(made_up.PROGRAMS[student][0])
    time.sleep(1.5)
    assert box.fault() == ""


def test_a_process_that_may_not_be_killed_protects_no_other(boxed, monkeypatch):
    """Without a sandbox a submission may start a program of another user: sudo."""
    box = boxed("import time\ntime.sleep(1000)\n")
    until, kill, first = time.monotonic() + LIMIT, os.kill, box._process.pid
    while not box._below():
        assert time.monotonic() < until, "it does not start"
        time.sleep(0.05)

    def kill_others(pid, number):
        if pid == first:
            raise PermissionError
        kill(pid, number)

    with monkeypatch.context() as patch:
        patch.setattr(os, "kill", kill_others)
        box._kill()
    assert "the program ended" in fault_of(box)


def test_printed_secrets_of_a_terminal_do_not_reach_the_reason(boxed):
    assert "\x1b" not in fault_of(boxed("raise RuntimeError('\\x1b[2J red')"))


def test_the_shipped_rules_are_hidden(boxed):
    program = ("import os\n"
               f"rules = {str(made_up.RULES.parent)!r}\n"
               "try:\n    open(rules + '/x', 'w')\n"
               "except OSError as error:\n    raise RuntimeError(os.listdir(rules), error.errno)\n")
    assert f"RuntimeError: ([], {errno.EROFS});" in fault_of(boxed(program))


def test_its_output_is_kept_but_bounded(boxed, tmp_path):
    fault_of(boxed(made_up.PROGRAMS["much_output"][0]))
    assert 0 < (tmp_path / "output.txt").stat().st_size <= 64 * 1024


def test_a_case_has_a_network_of_its_own(kind):
    look = "import os; print(sorted(os.listdir('/proc/self/net/dev_snmp6')), end='')"
    done = subprocess.run([*namespace(kind), sys.executable, "-c", look], capture_output=True,
                          text=True, check=True)
    assert done.stdout == "['lo']"
