"""Runs that begin together take turns; a child that is ended takes all with it that it started."""

import os
import re
import subprocess
import threading
import time
from pathlib import Path

import psutil
import pytest

from run_session.failure import RunError
from run_session.master import take_turn
from run_session.processes import Family, end_with_parent, strip_terminal_codes

pytestmark = pytest.mark.processes
ROOT = Path(__file__).resolve().parents[3]
# Ends at Ctrl-C; what it has started, in a session of its own, does not.
PARENT = ("import subprocess, sys, time; child = subprocess.Popen(['sh', '-c', 'trap \"\" INT; "
          "sleep 1000'], start_new_session=True); print(child.pid, flush=True); time.sleep(1000)")


def test_what_a_child_has_started_ends_with_it(tmp_path):
    family = Family()
    child = family.start("parent", ["python3", "-c", PARENT], os.environ, tmp_path / "log")
    until = time.monotonic() + 60.0
    while not (lines := child.new_lines()) and time.monotonic() < until:
        time.sleep(0.05)
    family.end(child, 0.5)
    assert not psutil.pid_exists(int(lines[0]))


def test_a_program_whose_parent_has_died_meanwhile_is_not_begun():
    nobody = 1 << 22  # more than Linux numbers processes
    assert subprocess.Popen(["sleep", "1000"], preexec_fn=end_with_parent(nobody)).wait(60) == 0


@pytest.mark.parametrize("code", [
    "\x1b[1;31m", "\x1b[2J", "\x1b[?25l", "\x1b]0;title\x07", "\x1bc", "\x1b"])
def test_no_code_of_a_program_s_output_reaches_the_terminal(code):
    assert strip_terminal_codes(f"a{code}\nb") == "a\nb"


def test_a_turn_is_waited_for_no_longer_than_the_limit(tmp_path):
    path = tmp_path / "run.lock"
    held = take_turn(path)
    with pytest.raises(RunError, match="is held by another run"):
        take_turn(path, 0.1)
    held.close()
    take_turn(path, 0.1).close()


def test_who_waits_for_its_turn_says_at_once_for_whom(tmp_path, capfd):
    path = tmp_path / f"course_run-{os.getuid()}.lock"
    held = take_turn(path)
    os.utime(path, (time.time() - 70,) * 2)
    with pytest.raises(RunError):
        take_turn(path, 0.1)
    said = capfd.readouterr().err
    assert re.fullmatch(rf"Waiting: \S+ \(process {os.getpid()}\) has been starting its "
                        r"simulator for 7\d s\n", said)
    waits = subprocess.Popen(
        ["bash", "-c", ". scripts/common.sh; take_turn", "scripts/viewer.sh"],
        cwd=ROOT, env=os.environ | {"TMPDIR": str(tmp_path)}, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert waits.stderr.readline().startswith(said.partition(" for ")[0])
    held.close()
    waits.communicate(timeout=60)
    assert waits.returncode == 0
    assert path.read_text() == f"{waits.pid}\n"


def test_who_has_waited_is_named_to_the_next(tmp_path, capfd):
    path = tmp_path / "run.lock"
    held = take_turn(path)
    threading.Timer(0.3, held.close).start()
    second = take_turn(path)
    assert path.read_text() == f"{os.getpid()}\n"
    with pytest.raises(RunError):
        take_turn(path, 0.1)
    second.close()
    for said in capfd.readouterr().err.splitlines():
        assert said.partition(") ")[0].endswith(f"(process {os.getpid()}")


def test_a_lock_that_leads_elsewhere_is_refused(tmp_path):
    """Another user may have put a link where everybody writes."""
    path = tmp_path / "run.lock"
    path.symlink_to(tmp_path / "precious")
    with pytest.raises(RunError, match="export TMPDIR="):
        take_turn(path)
    assert not (tmp_path / "precious").exists()
