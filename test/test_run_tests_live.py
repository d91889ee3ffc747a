"""The runner of the tests, run: what it tells of every way to fail, and that nothing runs on."""

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

pytestmark = pytest.mark.processes

ROOT = Path(__file__).resolve().parents[1]
MARKED = "import pytest\npytestmark = pytest.mark.processes\n"
TREE = {
    "test_plain.py": "import os, subprocess, pytest\n"
                     "def test_ok(): pass\n"
                     "def test_bad(): print('said so'); assert False\n"
                     "def test_skipped(): pytest.skip('no GPU')\n"
                     "def test_crash(): os._exit(3)\n"
                     "def test_after(): pass\n"
                     "def test_left(): subprocess.Popen(['sleep', '1000'])\n"
                     "@pytest.mark.timeout(1)\n"
                     "def test_hangs(): subprocess.run(['sleep', '1001'])\n",
    "test_import.py": "import there_is_none\n",
    "test_left.py": MARKED + "import subprocess, sys\n"
                    "def test_busy(): subprocess.run([sys.executable, '-c', 'import time\\n'\n"
                    "    'while time.process_time() < 3: pass'])\n"
                    "def test_it(): subprocess.Popen(['sleep', '1002'], start_new_session=True)\n",
    "test_crash.py": MARKED + "import os, signal\n"
                     "def test_ok(): pass\n"
                     "def test_it(): os.kill(os.getpid(), signal.SIGSEGV)\n",
    "test_once.py": MARKED + "from pathlib import Path\nHERE = Path(__file__).with_suffix('.x')\n"
                    "def test_ok(): pass\n"
                    "@pytest.mark.parametrize('a', ['b c'])\n"
                    "def test_it(a):\n"
                    "    if not HERE.exists(): HERE.touch(); assert False\n",
}


@pytest.fixture
def start(tmp_path, monkeypatch):
    """Starts the runner in a tree that has these test files."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    started = []

    def start(**files: str) -> subprocess.Popen:
        for name in ("scripts/run_tests.py", "scripts/run_tests_files.py", "conftest.py",
                     "pyproject.toml", "test/unsteady.yaml"):
            (tmp_path / name).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, tmp_path / name)
        props = tmp_path / "src/sim/bullet_sim/src/bullet_sim/props.py"  # conftest.py runs it
        props.parent.mkdir(parents=True)
        props.touch()
        for name, text in files.items():
            (tmp_path / "test" / name).write_text(text)
        started.append(subprocess.Popen([sys.executable, tmp_path / "scripts/run_tests.py"],
                                        text=True, cwd=tmp_path, stdout=subprocess.PIPE))
        return started[0]

    yield start
    for process in started:
        process.kill()
        process.wait()
        process.stdout.close()


def asleep(seconds: int) -> list[psutil.Process]:
    """Processes that sleep so long."""
    return [each for each in psutil.process_iter(["cmdline"])
            if each.info["cmdline"] == ["sleep", str(seconds)]]


def test_every_way_to_fail_is_told_and_nothing_runs_on(start, tmp_path):
    runner = start(**TREE)
    said, _ = runner.communicate()
    assert runner.returncode == 1
    failed = said.partition("\nFailed:\n")[2].splitlines()
    assert failed.pop() == "7 passed, 7 failed, 1 skipped", said
    assert sorted(line.strip() for line in failed) == [
        "test/test_crash.py: exit code -11, 0 tests ran",
        "test/test_import.py: test.test_import",
        "test/test_left.py: left running: sleep 1002, of test/test_left.py::test_it (call)",
        "test/test_plain.py: test_bad",
        "test/test_plain.py: test_crash",
        "test/test_plain.py: test_hangs",
        "without processes: left running: sleep 1000, of test/test_plain.py::test_left (call)"]
    assert "said so" in said and "      1  no GPU" in said
    assert "\n  test/test_once.py: test_it[b c]\n    E " in said
    assert "\nUNSTEADY: test/test_once.py: mend it" in said
    assert not any(map(asleep, (1000, 1001, 1002)))
    kept = json.loads((tmp_path / "cache/ros1-driving-courses/tests.json").read_text())
    assert kept["seconds"]["test/test_plain.py"] >= 1.0
    busy = kept["processor"]["test/test_left.py"]  # which has a process of its own, and that one
    assert busy >= 3.0 and f"processor seconds:\n{busy:9.1f} s  test/test_left.py\n" in said
    assert kept["unsteady"] == [["test/test_once.py"]]


def test_interrupted_it_ends_at_once_and_counts_nothing(start):
    sleeps = "import subprocess\ndef test_it(): subprocess.run(['sleep', '{}'])\n"
    runner = start(**{"test_a.py": sleeps.format(2000), "test_b.py": MARKED + sleeps.format(2001)})
    limit = time.monotonic() + 120
    while not (asleep(2000) and asleep(2001)):
        assert time.monotonic() < limit and runner.poll() is None
        time.sleep(0.1)
    runner.send_signal(signal.SIGINT)
    said, _ = runner.communicate(timeout=60)
    assert runner.returncode == 130 and "passed" not in said
    assert not asleep(2000) and not asleep(2001)


def test_nothing_that_ran_is_a_failure(start):
    said, _ = (runner := start()).communicate()
    assert runner.returncode == 1 and said.endswith("0 passed, 0 failed\n")
