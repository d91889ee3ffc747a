"""`make viewer`: course and page come up together, at a master of their own, and Ctrl-C ends both.

runs alone: the verbs know only the usual master, which other tests take while it is free.
"""

import contextlib
import os
import pty
import re
import select
import signal
import socket
import subprocess
import time
import urllib.request
import xmlrpc.client
from ipaddress import ip_address
from pathlib import Path

import psutil
import pytest

pytestmark = pytest.mark.processes
ROOT = Path(__file__).resolve().parents[4]
LIMIT = 180.0  # s, until the page serves
END_LIMIT = 60.0  # s, after Ctrl-C
SIMULATOR_RUNS = re.compile(r"A simulator runs already on this master \(world course, started \d+ "
                            r"(s|min) ago\)")
CPP_NODES = {"rosout", "robot_state_publisher"}  # of Debian's


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


@pytest.fixture
def usual_port_free():
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("", 11311))
        except OSError:
            return False
    return True


@pytest.fixture
def viewer(tmp_path, usual_port_free):
    """The verb, and the file with what it prints."""
    log = tmp_path / "output.txt"
    with log.open("wb") as output:
        process = subprocess.Popen(["make", "viewer", "CONTROL=1", f"PORT={free_port()}"],
                                   cwd=ROOT, stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
    yield process, log
    if process.poll() is None:  # SIGKILL would leave roslaunch's nodes, which are in other groups
        os.killpg(process.pid, signal.SIGINT)
        process.wait(END_LIMIT)


def test_a_master_that_is_not_there_is_named():
    done = subprocess.run(["make", "viewer"], cwd=ROOT, timeout=LIMIT, capture_output=True,
                          text=True, env={**os.environ, "LC_ALL": "C.UTF-8",
                                          "ROS_MASTER_URI": "http://nowhere.invalid:11311"})
    assert done.returncode == 2
    assert "unable to contact ROS master at [http://nowhere.invalid:11311]" in done.stderr


def address_in(log: Path, process) -> str:
    """The page's address, once it is printed."""
    until = time.monotonic() + LIMIT
    while time.monotonic() < until:
        if found := re.search(r"viewer: (http://\S+)", log.read_text()):
            return found[1]
        assert process.poll() is None, log.read_text()
        time.sleep(0.2)
    raise AssertionError(f"no address within {LIMIT} s: {log.read_text()}")


def listening(pid: int) -> set[tuple[str, bool]]:
    """Programs below this process that others can connect to, and whether only from here."""
    found = set()
    for each in psutil.Process(pid).children(recursive=True):
        words = " ".join(each.cmdline())
        name = next((word for word in ("rosmaster", "rosout", "sim_viewer", "gazebo")
                     if word in words), each.name())
        found |= {(name, ip_address(one.laddr.ip).is_loopback)
                  for one in each.net_connections("inet")
                  if one.status in (psutil.CONN_LISTEN, psutil.CONN_NONE)}
    return found


def test_course_and_page_come_and_go_together(viewer, usual_port_free):
    process, log = viewer
    with urllib.request.urlopen(address_in(log, process), timeout=60) as page:
        assert page.status == 200
        assert b"<script" in page.read()
    sockets = listening(process.pid)
    assert {"rosmaster", "gazebo", "sim_viewer"} <= {name for name, _ in sockets}, sockets
    # XML-RPC of Debian's roscpp listens everywhere, whatever is exported.
    assert {name for name, loopback in sockets if not loopback} <= CPP_NODES, sockets
    # A second terminal finds the usual one, where nobody else has it.
    assert usual_port_free == ("Another ROS master" not in log.read_text())
    said = again("viewer") if usual_port_free else None
    assert process.poll() is None
    if said is not None:
        assert SIMULATOR_RUNS.search(said)
        assert f"A page runs already: {address_in(log, process)}" in said
        assert SIMULATOR_RUNS.search(again("drive"))
    os.killpg(process.pid, signal.SIGINT)  # as a terminal's Ctrl-C: to all of them
    process.wait(END_LIMIT)
    assert "Traceback" not in log.read_text() and "make: ***" not in log.read_text()


def test_of_two_that_start_at_once_the_second_says_that_the_first_runs(tmp_path):
    uri, started = f"http://localhost:{free_port()}", []
    for number in range(2):
        with (tmp_path / str(number)).open("wb") as output:
            started.append(subprocess.Popen(
                ["make", "viewer", f"PORT={free_port()}"], cwd=ROOT, stdin=subprocess.DEVNULL,
                stdout=output, stderr=subprocess.STDOUT, start_new_session=True,
                env={**os.environ, "LC_ALL": "C.UTF-8", "ROS_MASTER_URI": uri}))
    try:
        until = time.monotonic() + LIMIT
        while all(each.poll() is None for each in started) and time.monotonic() < until:
            time.sleep(0.1)
        ended = next(number for number in range(2) if started[number].poll() is not None)
        assert SIMULATOR_RUNS.search((tmp_path / str(ended)).read_text())
        address_in(tmp_path / str(1 - ended), started[1 - ended])
    finally:
        for each in started:
            if each.poll() is None:
                os.killpg(each.pid, signal.SIGINT)
                each.wait(END_LIMIT)


def family(process: int) -> list[psutil.Process]:
    """This process and all below it."""
    return [psutil.Process(process), *psutil.Process(process).children(recursive=True)]


@pytest.fixture
def in_terminal():
    """Starts the verb as `ssh -t HOST make viewer` does: its pid and the terminal's other side."""
    started = []

    def start() -> tuple[int, int]:
        pid, terminal = pty.fork()
        if pid == 0:
            os.chdir(ROOT)
            os.execlp("bash", "bash", "-c", f"make viewer PORT={free_port()}")
        started.append(pid)
        return pid, terminal

    yield start
    for pid in started:
        with contextlib.suppress(ProcessLookupError, psutil.NoSuchProcess):
            os.killpg(pid, signal.SIGTERM)
            psutil.Process(pid).wait(END_LIMIT)


def read_until(terminal: int, text: str) -> str:
    """What is on the terminal, once it has this text."""
    shown = b""
    until = time.monotonic() + LIMIT
    while text.encode() not in shown:
        assert select.select([terminal], [], [], until - time.monotonic())[0], shown
        shown += os.read(terminal, 65536)
    return shown.decode()


def test_it_ends_with_the_terminal_of_which_make_is_the_leader(in_terminal):
    pid, terminal = in_terminal()
    read_until(terminal, "viewer: http://")
    all_of_it = family(pid)
    os.close(terminal)
    assert psutil.wait_procs(all_of_it, END_LIMIT)[1] == []


def course_starts(process: int) -> bool:
    """Whether its roslaunch is there, which has not set its handlers of signals yet."""
    with contextlib.suppress(psutil.NoSuchProcess):
        return any("0course.launch" in each.cmdline() and "python" in each.cmdline()[0]
                   for each in family(process))
    return False


def test_ctrl_c_ends_it_while_it_starts_and_make_adds_nothing(in_terminal):
    pid, terminal = in_terminal()
    read_until(terminal, "The course is starting")
    until = time.monotonic() + LIMIT
    while not course_starts(pid) and time.monotonic() < until:
        time.sleep(0.01)
    os.write(terminal, b"\x03")
    assert psutil.Process(pid).wait(END_LIMIT) in (0, -signal.SIGINT)
    shown = b""
    with contextlib.suppress(OSError):  # once all is read that its processes wrote
        while select.select([terminal], [], [], END_LIMIT)[0]:
            shown += os.read(terminal, 65536)
    assert b"make: ***" not in shown and b"Traceback" not in shown


def again(verb: str) -> str:
    """What a second terminal reads, where the verb must end at once with a failure."""
    done = subprocess.run(["make", verb], cwd=ROOT, text=True, stdin=subprocess.DEVNULL,
                          capture_output=True, timeout=LIMIT)
    assert done.returncode != 0
    return done.stdout + done.stderr


def test_a_course_that_dies_is_said_in_its_terminal(viewer):
    process, log = viewer
    address_in(log, process)
    (simulator,) = [each for each in psutil.Process(process.pid).children(recursive=True)
                    if "course.world" in " ".join(each.cmdline())]
    simulator.kill()
    assert process.wait(END_LIMIT) != 0
    assert "REQUIRED process [gazebo-" in log.read_text()
    assert "viewer: the course has ended, and with it the page; the full output is in " \
           "out/viewer.log" in log.read_text()


@pytest.fixture
def somebody_elses_master():
    """The usual port, taken: by this, or by whoever has it already."""
    with socket.socket() as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind(("", 11311))
            listener.listen()
        except OSError:
            pass
        yield


def test_a_container_ends_it_with_a_signal_to_the_script_alone(somebody_elses_master, tmp_path):
    log = tmp_path / "output.txt"
    with log.open("wb") as output:
        process = subprocess.Popen([ROOT / "scripts/viewer.sh", f"port:={free_port()}"],
                                   stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.STDOUT, start_new_session=True)
    try:
        address_in(log, process)
        (uri,) = re.findall(r"type: export ROS_MASTER_URI=(http://localhost:\d+)$",
                            log.read_text(), re.MULTILINE)
        assert xmlrpc.client.ServerProxy(uri).lookupNode("/test", "/sim_viewer")[0] == 1
        process.terminate()
        assert process.wait(END_LIMIT) == 130
        assert "Traceback" not in log.read_text()
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def test_a_file_that_cannot_be_shown_is_told_of_before_the_course_starts(tmp_path):
    done = subprocess.run(["make", "viewer", f"RVIZ={tmp_path}/none.rviz"], cwd=ROOT, text=True,
                          capture_output=True, timeout=LIMIT)
    said = f"rviz_page: {tmp_path}/none.rviz: No such file or directory; give a .rviz file"
    assert done.returncode == 2 and said in done.stderr.splitlines()


def master_chosen(**given: str) -> tuple[list[str], str]:
    """URI, ROS_HOSTNAME and ROS_IP that the verbs would use, and what they say about it."""
    cleared = {name: value for name, value in os.environ.items()
               if name not in ("ROS_MASTER_URI", "ROS_HOSTNAME", "ROS_IP")}
    show = ('. scripts/common.sh; enter_workspace; choose_master; '
            'echo "$ROS_MASTER_URI,${ROS_HOSTNAME:-},${ROS_IP:-}"')
    done = subprocess.run(["bash", "-c", show, ROOT / "scripts/viewer.sh"], cwd=ROOT, text=True,
                          env=cleared | given, capture_output=True, check=True)
    *said, last = done.stdout.splitlines()
    return last.split(","), "\n".join(said)


@pytest.mark.parametrize("port", ["0", "-1", "abc", "65536", "8080x", 'a" b'])
def test_a_port_that_is_none_is_told_of_before_setup(port, tmp_path):
    for name in ("viewer.sh", "common.sh"):  # and no setup.sh
        (tmp_path / name).write_bytes((ROOT / "scripts" / name).read_bytes())
    done = subprocess.run(["bash", tmp_path / "viewer.sh", f"port:={port}"], text=True,
                          capture_output=True, timeout=LIMIT, check=False)
    assert done.returncode == 2
    assert done.stderr == f"viewer: port is {port}; give one from 1 to 65535, such as PORT=8080\n"


def test_begun_in_the_background_of_a_script_it_heeds_ctrl_c_too(tmp_path):
    setup = tmp_path / "scripts/setup.sh"
    setup.parent.mkdir()
    for name in ("viewer.sh", "common.sh"):
        (setup.parent / name).write_bytes((ROOT / "scripts" / name).read_bytes())
    setup.write_text("#!/bin/sh\nkill -INT $PPID; exit 1\n", encoding="ascii")
    setup.chmod(0o755)
    done = subprocess.run(["bash", setup.parent / "viewer.sh"], check=False, timeout=LIMIT,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
    assert done.returncode == 0


def test_a_named_master_is_kept(somebody_elses_master):
    there = f"http://{socket.gethostname()}:11399"  # asks nobody outside this machine
    assert master_chosen(ROS_MASTER_URI=there) == ([there, "", ""], "")  # reached by its own name
    here = "http://127.0.0.1:11399"
    assert master_chosen(ROS_MASTER_URI=here) == ([here, "localhost", ""], "")
    assert master_chosen(ROS_MASTER_URI=there, ROS_IP="10.0.0.8")[0] == [there, "", "10.0.0.8"]
    assert master_chosen(ROS_MASTER_URI=there, ROS_HOSTNAME="me")[0] == [there, "me", ""]


def test_what_setup_bash_names_is_not_somebody_elses(somebody_elses_master):
    (uri, host, _), said = master_chosen(ROS_MASTER_URI="http://localhost:11311")
    assert uri != "http://localhost:11311" and host == "localhost"
    assert said.endswith(f"export ROS_MASTER_URI={uri}")
