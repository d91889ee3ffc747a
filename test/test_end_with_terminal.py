"""How the verbs end with their terminal: scripts/common.sh, in a tree with a stand-in for setup."""

import contextlib
import os
import pty
import select
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

ROOT = Path(__file__).resolve().parent.parent
LIMIT = 30.0  # s
GOES_ON = 2.0  # s, after which a program that was told to end would have ended
PROGRAM = """import os, pathlib, signal, time
def end(number, _frame):
    (here / "ended").write_text(f"{number}")
    raise SystemExit(130)
signal.signal(signal.SIGTERM, end)
if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
    signal.signal(signal.SIGHUP, end)
here = pathlib.Path("out/mark")
here.mkdir(parents=True)
(here / "pid").write_text(str(os.getpid()))
time.sleep(300)
"""
STAND_INS = """id() { echo 0; }
stat() { echo 1000; }
chown() { ls "$root/out/mark" > "$root/part"; mv "$root/part" "$root/owned"; }
export PYTHONPATH=$root/modules
roslaunch() { exec python3 src/evaluation/scripts/course_run.py; }
rosrun() { cat > keys; }
"""


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Verbs of this repository, with PROGRAM for what they start; root calls `make mark`."""
    for name in ("common.sh", "run.sh", "course.sh", "drive.sh", "mark.sh"):
        (tmp_path / "scripts").mkdir(exist_ok=True)
        shutil.copy(ROOT / "scripts" / name, tmp_path / "scripts")
    for name, text in (("scripts/setup.sh", "#!/bin/sh\n"), ("devel/setup.bash", STAND_INS),
                       ("src/evaluation/scripts/course_run.py", PROGRAM),
                       ("src/marking/scripts/mark.py", PROGRAM),
                       ("modules/bullet_sim_ros/only_simulator.py", ""),
                       ("modules/run_session/master.py", ""),
                       ("Makefile", "course drive mark:\n\t@scripts/$@.sh\n")):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
        (tmp_path / name).chmod(0o755)
    return tmp_path


@pytest.fixture
def in_terminal(tree: Path) -> Iterator[Callable[..., int]]:
    """Starts a command as the leader of a terminal, and returns the terminal's other side."""
    started = []

    def start(*command: str) -> int:
        pid, terminal = pty.fork()
        if pid == 0:
            os.chdir(tree)
            os.environ.pop("DISPLAY", None)
            os.environ["ROS_MASTER_URI"] = "http://localhost:1"
            os.execvp(command[0], command)
        started.append(pid)
        return terminal

    yield start
    for pid in started:
        with contextlib.suppress(psutil.NoSuchProcess):
            leader = psutil.Process(pid)
            for each in (*leader.children(recursive=True), leader):
                each.kill()
        os.waitpid(pid, 0)


def begun(terminal: int, tree: Path) -> psutil.Process:
    """The verb's program, once it runs."""
    until = time.monotonic() + LIMIT
    pid = tree / "out/mark/pid"
    while not (pid.is_file() and pid.read_text()):
        assert time.monotonic() < until
        if select.select([terminal], [], [], 0.05)[0]:
            os.read(terminal, 65536)
    return psutil.Process(int(pid.read_text()))


def outlives(program: psutil.Process) -> bool:
    """Whether it goes on, where it is not told to end; it is ended then."""
    gone, _ = psutil.wait_procs([program], GOES_ON)
    with contextlib.suppress(psutil.NoSuchProcess):
        program.kill()
    return not gone


def wait_for(path: Path) -> str:
    """The file's text, once it is there."""
    until = time.monotonic() + LIMIT
    while not path.exists():
        assert time.monotonic() < until, path
        time.sleep(0.05)
    return path.read_text("utf-8")


@pytest.mark.parametrize("command", [("make", "course"), ("make", "drive"),
                                     ("bash", "--norc", "-ic", "make course"),
                                     ("bash", "-c", "make course; true")])
def test_a_verb_ends_with_its_terminal(in_terminal, tree: Path, command: tuple[str, ...]) -> None:
    terminal = in_terminal(*command)
    program = begun(terminal, tree)
    os.close(terminal)
    assert psutil.wait_procs([program], LIMIT)[1] == []
    assert (tree / "out/mark/ended").exists()


def test_a_job_of_a_shell_ends_with_its_terminal(in_terminal, tree: Path) -> None:
    terminal = in_terminal("bash", "--norc", "-i")
    os.write(terminal, b"make course\n")
    program = begun(terminal, tree)
    os.close(terminal)
    assert psutil.wait_procs([program], LIMIT)[1] == []


def test_a_disowned_job_outlives_its_terminal(in_terminal, tree: Path) -> None:
    terminal = in_terminal("bash", "--norc", "-i")
    os.write(terminal, b"make course\n")
    program = begun(terminal, tree)
    os.write(terminal, b"\x1a")
    os.write(terminal, b"bg; disown; touch disowned\n")
    wait_for(tree / "disowned")
    os.close(terminal)
    assert outlives(program)


@pytest.mark.parametrize("leader", [("bash", "--norc", "-i"), ("sh", "+m")])
def test_nohup_outlives_its_terminal(in_terminal, tree: Path, leader: tuple[str, ...]) -> None:
    terminal = in_terminal(*leader)
    os.write(terminal, b"nohup make course > log 2>&1 &\n")
    program = begun(terminal, tree)
    os.close(terminal)
    assert outlives(program)


def close(terminal: int, _program: psutil.Process) -> None:
    os.close(terminal)


def interrupt(terminal: int, _program: psutil.Process) -> None:
    os.write(terminal, b"\x03")


def terminate(_terminal: int, program: psutil.Process) -> None:
    program.parent().terminate()  # mark.sh alone, as a make that is ended does


@pytest.mark.parametrize("end", [close, interrupt, terminate])
def test_roots_marks_are_the_users_after_the_last_is_written(in_terminal, tree: Path, end) -> None:
    terminal = in_terminal("make", "mark")
    program = begun(terminal, tree)
    end(terminal, program)
    assert wait_for(tree / "owned").split() == ["ended", "pid"]
