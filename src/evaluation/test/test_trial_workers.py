"""Cases handed to Dask workers: by threads of the program, and by a scheduler with workers."""

import contextlib
import json
import os
import re
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from ipaddress import ip_address
from pathlib import Path

import psutil
import pytest
from sleep_trial import SleepTrial

from evaluation.command_line import INTERRUPTED, NOT_RUN, PASSED
from evaluation.trial import run_trial

pytestmark = pytest.mark.processes
HERE = Path(__file__).parent
LIMIT = 60.0  # s, wall, for what takes 2 s on a quiet machine


@pytest.fixture(autouse=True, scope="module")
def on_path():
    """Processes find the trial."""
    before = filter(None, [str(HERE), os.environ.get("PYTHONPATH", "")])
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join(before))
        yield


def run(out, *words):
    return run_trial(SleepTrial(), ["--out", str(out), *map(str, words)])


def start(out, *words):
    """The trial as a program."""
    text = ("import sys; from sleep_trial import SleepTrial; from evaluation.trial import"
            " run_trial; sys.exit(run_trial(SleepTrial(), sys.argv[1:]))")
    return subprocess.Popen(
        [sys.executable, "-c", text, "--out", str(out), *map(str, words)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def names(out):
    return [each["name"] for each in json.loads((out / "report.json").read_text())["naps"]]


def naps(count):
    return [f"nap-{number}" for number in range(count)]


def sleepers(seconds):
    """Processes of cases that sleep so long: `sleep` itself, which a case leaves to its session."""
    text = f"sleep\0{seconds + 60}\0".encode()
    found = []
    for entry in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):
            if Path("/proc", entry, "cmdline").read_bytes() == text:
                found.append(int(entry))
    return found


def until(condition):
    end = time.monotonic() + LIMIT
    while not (value := condition()):
        assert time.monotonic() < end
        time.sleep(0.05)
    return value


# --- on this machine


def test_results_are_in_order_and_each_case_has_a_folder_of_its_own(tmp_path, capfd):
    assert run(tmp_path, "--workers", 2, "--naps", 3, "--seconds", 0.01) == PASSED
    report = json.loads((tmp_path / "report.json").read_text())["naps"]
    assert report == [{"name": name, "files": 1} for name in naps(3)]
    assert sorted(path.name for path in (tmp_path / "naps").iterdir()) == naps(3)
    assert not list(tmp_path.glob(".case*"))
    shown = capfd.readouterr()
    assert shown.out.startswith("3 cases, 2 at a time; each has a line when it is done\n")
    assert "[3/3]" in shown.out and shown.err == ""


def test_a_case_that_cannot_be_run_is_a_line_and_resume_tries_it_again(tmp_path, capfd):
    words = ["--workers", 2, "--naps", 3, "--seconds", 0.01]
    assert run(tmp_path, *words, "--fails", "nap-1", "--dies", "nap-2") == NOT_RUN
    assert names(tmp_path) == ["nap-0"]
    said = capfd.readouterr().err
    bed = f"nap-1: could not be run: the bed broke; log: {tmp_path / 'log'}"
    killed = "nap-2: could not be run: killed by signal 9, SIGKILL"
    assert f"a creak\nsleep_trial: {bed}\n" in said and f"sleep_trial: {killed}\n" in said
    assert said.endswith("sleep_trial: 2 of 3 cases could not be run; --resume tries them again\n")
    assert bed in (tmp_path / "report.html").read_text()
    assert (tmp_path / "log").exists()  # what it left
    assert run(tmp_path, *words, "--resume") == PASSED
    assert names(tmp_path) == naps(3)
    assert "nap-0 slept" not in capfd.readouterr().out
    assert run(tmp_path, *words, "--resume") == PASSED  # nothing is left to try
    assert "slept\n" in capfd.readouterr().out


def test_no_more_cases_are_counted_than_one_after_the_other_would_try(tmp_path):
    words = ["--workers", 3, "--naps", 30, "--seconds", 0.02, "--enough", 2]
    assert run(tmp_path, *words) == PASSED
    assert names(tmp_path) == naps(2)


def test_ctrl_c_keeps_what_is_done_and_ends_the_rest(tmp_path):
    seconds = 0.8125
    trial = start(tmp_path, "--workers", 2, "--naps", 50, "--seconds", seconds)
    until(lambda: (tmp_path / "report.json").exists() and sleepers(seconds))
    trial.send_signal(signal.SIGINT)
    _, said = trial.communicate(timeout=LIMIT)
    assert (trial.returncode, said.splitlines()[-1:]) == (
        INTERRUPTED, ["sleep_trial: interrupted; all processes ended"])
    assert 0 < len(names(tmp_path)) < 50
    assert not sleepers(seconds)


def test_no_other_machine_can_connect_to_it(tmp_path):
    seconds = 30.1875
    trial = start(tmp_path, "--workers", 2, "--seconds", seconds)
    until(lambda: len(sleepers(seconds)) == 2)
    found = [ip_address(each.laddr.ip) for each in psutil.Process(trial.pid).net_connections("inet")
             if each.status in (psutil.CONN_LISTEN, psutil.CONN_NONE)]
    trial.send_signal(signal.SIGINT)
    trial.communicate(timeout=LIMIT)
    assert all(address.is_loopback for address in found), found


def test_a_killed_program_takes_its_cases_with_it(tmp_path):
    seconds = 30.0625
    trial = start(tmp_path, "--workers", 2, "--seconds", seconds)
    until(lambda: len(sleepers(seconds)) == 2)
    trial.kill()
    trial.communicate()
    until(lambda: not sleepers(seconds))


@pytest.mark.parametrize(("words", "said"), [
    (["--workers", "0"], "--workers (WORKERS=) must be a whole number, 1 to 1000; got '0'"),
    (["--workers", "2", "--scheduler", "tcp://a:1"], "give one"),
    (["--scheduler", "tcp://127.0.0.1:9"], "no Dask scheduler at tcp://127.0.0.1:9"),
    (["--scheduler", "nonsense://a:1"], "no Dask scheduler at nonsense://a:1"),
    (["--scheduler", "127.0.0.1"], "such as tcp://192.168.0.10:8786; got '127.0.0.1'"),
    (["--scheduler", "tcp://127.0.0.1"], "such as tcp://192.168.0.10:8786; got 'tcp://127.0.0.1'"),
])
def test_a_mistake_is_one_line(tmp_path, capfd, monkeypatch, words, said):
    from evaluation import workers

    monkeypatch.setattr(workers, "CONNECT_TIME", 0.5)
    assert run(tmp_path, *words) == NOT_RUN
    (line,) = capfd.readouterr().err.strip().splitlines()
    assert said in line


def test_dask_adds_nothing_to_the_line_when_the_program_ends(tmp_path):
    trial = start(tmp_path, "--scheduler", "nonsense://a:1")
    (line,) = trial.communicate(timeout=LIMIT)[1].strip().splitlines()
    assert "no Dask scheduler at nonsense://a:1" in line and trial.returncode == NOT_RUN


def test_without_dask_one_line_says_what_to_type(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "evaluation.workers", None)
    assert run(tmp_path, "--workers", "2") == NOT_RUN
    assert "scripts/setup.sh --workers" in capsys.readouterr().err


# --- on a scheduler's workers


class Proxy:
    """A port that leads to another, until it is cut."""

    def __init__(self, port):
        self._to, self._open = port, []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"tcp://127.0.0.1:{self._listener.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                pair = self._listener.accept()[0], socket.create_connection(
                    ("127.0.0.1", self._to))
                self._open += pair
                threading.Thread(target=self._hand_on, args=pair, daemon=True).start()

    @staticmethod
    def _hand_on(one, other):
        ways = {one: other, other: one}
        with contextlib.suppress(OSError, ValueError), one, other:
            while True:
                for ready in select.select(list(ways), [], [])[0]:
                    if not (data := ready.recv(1 << 16)):
                        return
                    ways[ready].sendall(data)

    def cut(self):
        """Connections that are made later work."""
        for each in self._open:
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
        self._open.clear()

    def close(self):
        self.cut()
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()


class Cluster:
    """`dask scheduler` and some `dask worker`s."""

    def __init__(self, folder):
        self._folder, self.workers = folder, []
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0",
                                     "--no-dashboard", "--no-show")
        log = folder / "scheduler.log"
        found = until(lambda: re.search(r"Scheduler at:\s+tcp://127\.0\.0\.1:(\d+)",
                                        log.read_text()))
        self.port = int(found[1])
        self.address = f"tcp://127.0.0.1:{self.port}"

    def add_worker(self, address=""):
        self.workers.append(self._start(
            "worker", address or self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard",
            "--local-directory", str(self._folder)))
        return self.workers[-1]

    def worker(self):
        """One that lives, from a test before or a new one."""
        living = [each for each in self.workers if each.poll() is None]
        return living[0] if living else self.add_worker()

    def _start(self, what, *words):
        with (self._folder / f"{what}.log").open("ab") as log:
            return subprocess.Popen([sys.executable, "-m", "dask", what, *words],
                                    stdout=log, stderr=log, start_new_session=True)

    def end(self):
        for each in (*self.workers, self.scheduler):
            each.kill()
            each.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory, on_path):
    made = Cluster(tmp_path_factory.mktemp("cluster"))
    yield made
    made.end()


@pytest.fixture
def proxy(cluster):
    made = Proxy(cluster.port)
    yield made
    made.close()


def ends_well(trial, out, count, seconds):
    said, errors = trial.communicate(timeout=LIMIT)
    assert trial.returncode == PASSED, errors
    assert names(out) == naps(count)
    assert said.count(" slept\n") == count + 1  # a line each, once, and the table
    until(lambda: not sleepers(seconds))


def test_a_killed_workers_cases_are_tried_elsewhere_and_its_processes_end(tmp_path, cluster):
    seconds, out = 1.0625, tmp_path / "out"
    trial = start(out, "--scheduler", cluster.address, "--naps", 6, "--seconds", seconds)
    assert trial.stdout.readline().startswith("6 cases, on the workers of tcp://")
    assert "no workers" in trial.stdout.readline()
    killed = cluster.add_worker()
    until(lambda: sleepers(seconds))
    cluster.add_worker()
    killed.kill()
    killed.wait()
    ends_well(trial, out, 6, seconds)


def test_a_cut_connection_of_program_or_worker_loses_and_doubles_nothing(
        tmp_path, cluster, proxy):
    seconds, out = 0.5625, tmp_path / "out"
    cluster.worker()
    behind_proxy = cluster.add_worker(proxy.address)
    trial = start(out, "--scheduler", proxy.address, "--naps", 8, "--seconds", seconds)
    until(lambda: (out / "report.json").exists() and sleepers(seconds))
    proxy.cut()
    ends_well(trial, out, 8, seconds)
    behind_proxy.kill()
    behind_proxy.wait()


def test_ctrl_c_frees_the_workers(tmp_path, cluster):
    seconds, out = 20.3125, tmp_path / "out"
    worker = cluster.worker()
    trial = start(out, "--scheduler", cluster.address, "--seconds", seconds)
    until(lambda: sleepers(seconds))
    trial.send_signal(signal.SIGTERM)
    trial.communicate(timeout=LIMIT)
    assert trial.returncode == INTERRUPTED
    until(lambda: not sleepers(seconds))
    assert worker.poll() is None


def test_a_scheduler_that_goes_away_ends_the_run_and_keeps_what_is_done(tmp_path, cluster):
    seconds, out = 0.3125, tmp_path / "out"
    cluster.worker()
    trial = start(out, "--scheduler", cluster.address, "--naps", 50, "--seconds", seconds)
    until((out / "report.json").exists)
    cluster.scheduler.kill()
    _, errors = trial.communicate(timeout=LIMIT)
    assert trial.returncode == NOT_RUN, errors
    assert errors.splitlines()[-1].endswith("--resume goes on"), errors
    assert 0 < len(names(out)) < 50
    until(lambda: not sleepers(seconds))
