"""A follower at a debugger's breakpoint: the run goes on as if nothing had happened."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import pytest
from debug_client import LIMIT, DebugClient
from node_basics import debugging

from run_session.files import find_package

pytestmark = pytest.mark.processes
ROOT = Path(__file__).resolve().parents[3]
COURSE_RUN = ROOT / "src/evaluation/scripts/course_run.py"
LESSON = find_package("learning_topic") / "scripts/05follower_proporation.py"
STEERS = next(number for number, line in enumerate(LESSON.read_text("utf-8").splitlines(), 1)
              if "command.angular.z = steer(" in line)
STAND = 3.0  # s, wall, at a breakpoint


@pytest.fixture
def start(tmp_path):
    """Starts programs whose output goes to a file; ends what a failed test leaves."""
    programs = []

    def start_program(*command, **options):
        log = tmp_path / f"output-{len(programs)}.txt"
        with log.open("wb") as output:
            programs.append(subprocess.Popen(
                command, stdout=output, stderr=subprocess.STDOUT, start_new_session=True,
                cwd=tmp_path, **options))
        return programs[-1], log

    yield start_program
    for program in programs:
        if program.poll() is None:
            os.killpg(program.pid, signal.SIGINT)
            program.wait(LIMIT)


def free_port():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


def wait_for(log, words):
    until = time.monotonic() + LIMIT
    while words not in log.read_text():
        assert time.monotonic() < until, log.read_text()
        time.sleep(0.05)


def drive(start, out, *launch_args):
    """A short drive in lockstep that has a fingerprint, and ends if time stands still for 1 s."""
    words = ("lockstep_timeout:=0", *launch_args)
    return start(
        sys.executable, str(COURSE_RUN), "--out", str(out), "--fast", "--fingerprint", "--any-port",
        "--seed", "3", "--duration", "1.5", "--camera", "320x180", "--stuck-timeout", "1",
        *(word for each in words for word in ("--launch-arg", each)))


def figures(out):
    report = json.loads((out / "report.json").read_text("utf-8"))
    return {key: report[key] for key in (
        "drive_sha256", "sensor_sha256", "frames_sent", "frames_answered", "simulated_s")}


def simulated_time(log):
    """s, of the run's own simulator, by its service."""
    master = re.search(r"export ROS_MASTER_URI=(\S+);", log.read_text())[1]
    said = subprocess.run(["rosservice", "call", "/gazebo/get_world_properties"], check=True,
                          env=os.environ | {"ROS_MASTER_URI": master}, capture_output=True,
                          text=True, timeout=LIMIT).stdout
    return float(re.search(r"sim_time: (\S+)", said)[1])


@pytest.mark.timeout(400)
def test_a_run_with_breakpoints_has_the_bits_of_one_without(start, tmp_path):
    port = free_port()
    plain, log = drive(start, tmp_path / "plain")
    assert plain.wait(LIMIT) == 0, log.read_text()
    debugged, log = drive(start, tmp_path / "debugged",
                          f"launch_prefix:=rosrun node_basics debug --port {port}")
    editor = DebugClient.connect(port)
    editor.begin("attach", {"connect": {"host": "127.0.0.1", "port": port}}, {LESSON: [STEERS]})
    times = []
    for hit in range(3):
        thread, frame = editor.stopped()
        assert (frame["line"], frame["name"]) == (STEERS, "image_callback")
        shown = editor.locals(frame)
        assert re.fullmatch(r"\(\d+, \d+\)", shown["centre"]), shown["centre"]
        times.append(simulated_time(log))
        if hit == 0:
            time.sleep(STAND)
            assert simulated_time(log) == times[0]
            editor.ask("next", threadId=thread)
            _, frame = editor.stopped()
            assert frame["line"] == STEERS + 1
        if hit == 2:
            editor.ask("setBreakpoints", source={"path": str(LESSON)}, breakpoints=[])
        editor.ask("continue", threadId=thread)
    assert [round(after - before, 2) for before, after in pairwise(times)] == [0.03, 0.03]
    assert debugged.wait(LIMIT) == 0, log.read_text()
    assert figures(tmp_path / "debugged") == figures(tmp_path / "plain")


def configurations(name):
    """A file of .vscode, without the comments that such files may have."""
    lines = (ROOT / ".vscode" / name).read_text("utf-8").splitlines()
    text = "\n".join(line for line in lines if not line.lstrip().startswith("//"))
    return json.loads(text.replace("${workspaceFolder}", str(ROOT)))


CONFIGURATIONS = {each["name"]: each for each in configurations("launch.json")["configurations"]}


def test_this_program_in_the_editor_stops_at_a_breakpoint(start, tmp_path):
    """As Visual Studio Code does it: its adapter asks to run the program in a terminal."""
    program = tmp_path / "program.py"
    program.write_text("import rospy\nimport numpy\nwords = [1, 2]\nprint(sum(words))\n")
    adapter = subprocess.Popen([sys.executable, "-m", "debugpy.adapter"], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE)
    editor = DebugClient.of(adapter)
    ran = []

    def run_in_terminal(arguments):
        # The editor was started from a menu: nothing is sourced.
        bare = {name: os.environ[name] for name in ("HOME", "LANG") if name in os.environ}
        environment = bare | {"PATH": "/usr/bin:/bin"} | (arguments.get("env") or {})
        ran.append(start(*arguments["args"], env=environment))

    editor.terminal = run_in_terminal
    try:
        settings = CONFIGURATIONS["This program"]
        assert settings["program"] == "${file}"
        editor.begin("launch", settings | {"program": str(program)}, {program: [4]})
        thread, frame = editor.stopped()
        assert editor.locals(frame)["words"] == "[1, 2]"
        editor.ask("continue", threadId=thread)
        editor.event("terminated")
    finally:
        adapter.kill()
        adapter.communicate()
    process, log = ran[0]
    assert process.wait(LIMIT) == 0 and "3" in log.read_text()


def test_the_editors_attach_to_what_our_command_starts():
    from node_basics import debugging

    for name in ("Attach", "course_follow.launch"):
        assert CONFIGURATIONS[name]["connect"] == {"host": debugging.HERE, "port": debugging.PORT}
    task, = configurations("tasks.json")["tasks"]
    assert task["label"] == CONFIGURATIONS["course_follow.launch"]["preLaunchTask"]
    done = subprocess.run([task["command"], *task["args"], "--nodes"], capture_output=True,
                          text=True, timeout=LIMIT, check=True)
    assert "/follower" in done.stdout.split()


def debug(*words):
    """The command with its output, and without the workspace's own colours."""
    return ["rosrun", "node_basics", "debug", *map(str, words)]


@pytest.mark.parametrize(("text", "words"), [
    ("print(1\n", "program.py:1: '(' was never closed: print(1"),
    ("x = '\0'", "program.py"),
    (None, "program.py: No such file or directory"),
])
def test_what_is_no_program_is_one_line(tmp_path, text, words):
    program = tmp_path / "program.py"
    if text is not None:
        program.write_text(text)
    done = subprocess.run(debug(program), capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 2
    line, = done.stderr.splitlines()
    assert words in line


@pytest.mark.parametrize(("words", "said"), [
    ([], "debug: name a program: rosrun node_basics debug FILE [ARGUMENTS]"),
    (["--port", "5679"], "debug: name a program: rosrun node_basics debug FILE [ARGUMENTS]")])
def test_without_a_program_a_line_says_what_to_type(words, said):
    done = subprocess.run(debug(*words), capture_output=True, text=True, timeout=LIMIT)
    assert (done.returncode, done.stderr) == (
        2, f"{said} (see: rosrun node_basics debug --help)\n")


def test_a_port_of_root_s_is_not_called_taken(monkeypatch):
    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(debugging.socket.socket, "bind", refuse)
    assert debugging.taken(80) == (
        "port 80 is root's: choose one from 1024, as 5678 without --port")


def test_a_taken_port_a_second_debugger_and_ctrl_c_are_one_line_each(start, tmp_path):
    program = tmp_path / "program.py"
    program.write_text("import time\ntime.sleep(100)\n")
    port = free_port()
    first, log = start(*debug("--port", port, program))
    wait_for(log, f"debug: program.py waits for a debugger at 127.0.0.1:{port}")
    editor = DebugClient.connect(port)
    done = subprocess.run(debug("--port", port, program), capture_output=True, text=True,
                          timeout=LIMIT)
    line, = done.stderr.splitlines()
    assert done.returncode == 2 and f"port {port} is taken" in line
    assert f"--port {port + 1}" in line
    editor.begin("attach", {"justMyCode": True}, {program: [2]})
    editor.stopped()
    with pytest.raises(AssertionError, match="is already being debugged"):
        DebugClient.connect(port).begin("attach", {"justMyCode": True}, {})
    editor.ask("disconnect", terminateDebuggee=True)
    first.wait(LIMIT)
    waiting, log = start(*debug("--port", free_port(), program))
    wait_for(log, "waits for")
    os.killpg(waiting.pid, signal.SIGINT)
    assert waiting.wait(LIMIT) == 130
    assert len(log.read_text().splitlines()) == 1, log.read_text()
