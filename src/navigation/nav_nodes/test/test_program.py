"""Programs that are told to end, at every moment: at once, without a traceback."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
NODES = Path(__file__).parents[2]
SCRIPTS = sorted(path for path in NODES.glob("*/scripts/*") if path.is_file())
SIGNALS = (signal.SIGINT, signal.SIGTERM)
ENDS = 1.0  # s


def catches_both(process):
    """Whether its own handlers are in place."""
    for line in Path(f"/proc/{process.pid}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("SigCgt:"):
            return all(int(line.split()[1], 16) >> (number - 1) & 1 for number in SIGNALS)
    return False


def wait_until(condition, limit=60.0):
    """For a condition to become true."""
    end = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)


@pytest.fixture
def start(tmp_path):
    """Starts a command that finds no master; its output goes to `process.said`."""
    begun = []

    def start_command(*command, **more):
        file = (tmp_path / "said").open("w")
        process = subprocess.Popen(
            [str(part) for part in command], stdout=file, stderr=subprocess.STDOUT, cwd=tmp_path,
            start_new_session=True,
            env={**os.environ, "ROS_MASTER_URI": "http://localhost:1", **more,
                 "ROS_LOG_DIR": str(tmp_path), "PYTHONUNBUFFERED": "1"})
        process.said = (tmp_path / "said").read_text
        begun.append(process)
        return process

    yield start_command
    for process in begun:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def ends(process, number):
    """Its exit status when the signal has come; in time and without a traceback."""
    process.send_signal(number)
    status = process.wait(ENDS)
    assert "Traceback" not in process.said(), process.said()
    return status


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_while_it_imports(start, script, number):
    process = start(sys.executable, script, *["map"] * (script.name != "move_base"))
    wait_until(lambda: catches_both(process))
    assert ends(process, number) == 128 + number


@pytest.mark.parametrize("script", ["amcl/scripts/amcl", "map_server/scripts/map_server"])
def test_while_it_waits_for_the_master(start, script):
    process = start(sys.executable, NODES / script, "map")
    wait_until(lambda: "No ROS master at" in process.said())
    assert ends(process, signal.SIGINT) == 128 + signal.SIGINT


BEGIN = "import time\nfrom nav_nodes import program\n"
DURING_IMPORT = "print('here')\ntime.sleep(90)\n"
FAILING = "def main():\n    raise RuntimeError('my own')\n"
RETURNING = "def main():\n    return 7\n"
EXITING = "def main():\n    raise SystemExit('one line')\n"
STUCK = """
def main():
    program._begun.set()
    program._shut_down = lambda _reason: None
    print('here')
    time.sleep(90)
"""


def run_of(start, tmp_path, text):
    (tmp_path / "made_up.py").write_text(BEGIN + text, encoding="utf-8")
    return start(sys.executable, "-c", "from nav_nodes.program import run; run('made_up')",
                 PYTHONPATH=f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}")


@pytest.mark.parametrize("text", [DURING_IMPORT, STUCK])
def test_what_hangs_ends_too(start, tmp_path, text):
    process = run_of(start, tmp_path, text)
    wait_until(lambda: "here" in process.said())
    assert ends(process, signal.SIGTERM) == 128 + signal.SIGTERM


@pytest.mark.parametrize("text, status, said", [
    (RETURNING, 7, ""), (EXITING, 1, "one line\n"), (FAILING, 1, "RuntimeError: my own\n")])
def test_what_ends_by_itself_says_how(start, tmp_path, text, status, said):
    process = run_of(start, tmp_path, text)
    assert process.wait(60) == status
    assert process.said().endswith(said)
    assert ("Traceback" in process.said()) == (text == FAILING)


@pytest.mark.parametrize("before, status", [("", 1), ("unset PYTHONUNBUFFERED; ", 7)])
def test_a_reader_that_has_ended_costs_no_traceback(start, tmp_path, before, status):
    (tmp_path / "made_up.py").write_text("def main():\n    print('x')\n    return 7\n", "utf-8")
    process = start("sh", "-c", f"""{before}({sys.executable} -c "
from nav_nodes.program import run
run('made_up')"; echo ended $? >&2) | exec true""",
                    PYTHONPATH=f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}")
    process.wait(60)
    wait_until(lambda: "ended" in process.said())
    assert process.said() == f"ended {status}\n"


PEAKS = """
import sys
import numpy as np
{begin}
def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4096 / 2**20
def peak(mebibytes):
    arrays = [np.ones(int(mebibytes * 2**20), np.uint8) for _ in range(int(60 / mebibytes))]
    return np.ones(3000, np.uint8)  # stays, above them
before, kept = resident(), []
for number in range(30):
    kept.append(peak((15, 3, 0.5)[number % 3]))
print(resident() - before)
"""


@pytest.mark.parametrize("begin, least, most", [
    ("from nav_nodes.program import give_memory_back; give_memory_back()", -5, 5),
    ("", 50, 100)])
def test_memory_of_a_peak_is_given_back(begin, least, most):
    """In the workspace's environment it is kept, once, by a program that does not say otherwise."""
    done = subprocess.run(
        [sys.executable, "-c", PEAKS.format(begin=begin)], capture_output=True, text=True,
        check=True, env={**os.environ, "MALLOC_MMAP_THRESHOLD_": str(1 << 25),
                         "MALLOC_TRIM_THRESHOLD_": str(1 << 26)})
    assert least < float(done.stdout) < most
