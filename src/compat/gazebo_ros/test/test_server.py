"""gzserver and gzclient: Gazebo's options to the node's, and processes that end when told."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest
from gazebo_ros.server import node_arguments

from bullet_sim import __version__

SCRIPTS = Path(__file__).resolve().parents[1] / "scripts"
FAKE_NODE = """
import os, signal, sys, time
def stop(*_):
    os.write(1, b"stopped\\n")  # print may be at work below the handler
    os._exit(3)
signal.signal(signal.SIGINT, stop)
profiled = sys.getprofile() is not None
if hasattr(sys, "monitoring"):  # Python 3.12 and later
    profiled = sys.monitoring.get_tool(sys.monitoring.PROFILER_ID) is not None
print(os.getpid(), sys.flags.dev_mode, profiled, sys.flags.safe_path, *sys.argv[1:], flush=True)
time.sleep(200)
"""
PLAIN = ["--world", "worlds/empty.world", "--physics", "ode"]


@pytest.mark.parametrize(("words", "expected"), [
    ([], PLAIN),
    (["-e", "bullet", "/a b.world"], ["--world", "/a b.world", "--physics", "bullet"]),
    (["-u", "-r", "--verbose", "-e", "ode"], [*PLAIN, "--paused", "--verbose"]),
    (["--seed", "-4", "--iters", "5", "--initial_sim_time", "2.5"],
     [*PLAIN, "--seed=-4", "--iters=5", "--initial-sim-time=2.5"]),
    (["--real_time_factor", "0"], [*PLAIN, "--real-time-factor=0"]),
    (["__name:=gazebo", "x.world", "/scan:=/s"],
     ["--world", "x.world", "--physics", "ode", "__name:=gazebo", "/scan:=/s"]),
    (["-s", "libgazebo_ros_api_plugin.so", "-p", "log", "-o", "fast", "-g", "lib.so", "--lockstep",
      "--minimal_comms", "--record_path", "p", "--record_period", "1", "--record_filter", "f",
      "--record_encoding", "txt", "--record_resources"], PLAIN),
    (["--nobody-knows", "x.world", "second", "third"],
     ["--world", "x.world", "--physics", "ode"]),
])
def test_gazebos_options_become_the_nodes(words, expected):
    # conforms: gzserver, gzserver/WORLD, gzserver/-u, gzserver/--verbose, gzserver/-e
    # conforms: gzserver/remappings, gzserver/unknown options, gzserver/--seed, gzserver/--iters
    # conforms: gzserver/--initial_sim_time, gzserver/--real_time_factor
    assert node_arguments("gzserver", words) == expected


@pytest.fixture
def start(tmp_path):
    """Starts a script with a node that only tells what it was given; kills what is left."""
    package = tmp_path / "bullet_sim_ros"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "package_paths.py").write_text("def unreadable_world(name): return ''")
    (package / "__main__.py").write_text(FAKE_NODE)
    running = []

    def start_script(name, *words, **variables):
        path = f"{tmp_path}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"
        process = subprocess.Popen(
            [sys.executable, SCRIPTS / name, *words], text=True, cwd=tmp_path,
            env=os.environ | {"PYTHONPATH": path} | variables,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        running.append(process)
        return process

    yield start_script
    for process in running:
        process.kill()
        process.communicate()


@pytest.mark.parametrize(("name", "dev", "profiled"), [
    ("gzserver", "False", "False"), ("debug", "True", "False"), ("perf", "False", "True")])
def test_the_script_becomes_the_node(start, name, dev, profiled):
    # conforms: gzserver, perf, debug
    process = start(name, "-u", "a.world", "__name:=gazebo")
    assert process.stdout.readline().split() == [
        str(process.pid), dev, profiled, "True", "--world", "a.world", "--physics", "ode",
        "--paused", "__name:=gazebo"]
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "stopped\n" and process.wait(60) == 3


def test_gazebo_in_a_launch_file_is_the_clients_line_and_the_server(start):
    # conforms: gazebo
    process = start("gazebo", "a.world", "__name:=gazebo")
    assert "image_view" in process.stdout.readline()
    assert process.stdout.readline().split()[0] == str(process.pid)


def test_gazebo_typed_is_roslaunch_with_the_world_and_the_page(start, tmp_path):
    (tmp_path / "my own.world").touch()
    roslaunch = tmp_path / "roslaunch"
    roslaunch.write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n')
    roslaunch.chmod(0o755)
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    said, _ = start("gazebo", "-u", "my own.world", PATH=path).communicate(timeout=60)
    assert said.splitlines() == [
        "gazebo_ros", "empty_world.launch", "gui:=false", "viewer:=true", "server_required:=true",
        f"extra_gazebo_args:=-u '{tmp_path}/my own.world'"]


@pytest.mark.parametrize(("world", "reason"), [
    ("nothere.world", "nothere.world not found (searched: "),
    ("broken.world", "Could not open file broken.world: ")])
def test_a_world_that_cannot_be_read_ends_it_without_a_master(tmp_path, world, reason):
    (tmp_path / "broken.world").write_text("<sdf><world")
    for name in ("gazebo", "gzserver"):
        done = subprocess.run(
            [sys.executable, SCRIPTS / name, world], text=True, cwd=tmp_path, timeout=60,
            env=os.environ | {"ROS_MASTER_URI": "http://127.0.0.1:9"}, capture_output=True,
            check=False)
        assert (done.returncode, done.stdout) == (1, "")
        assert done.stderr.startswith(f"[FATAL] {reason}")
        assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("name", ["gzserver", "gzclient", "gazebo", "debug"])
@pytest.mark.parametrize("option", ["-h", "--help", "-v", "--version"])
def test_help_and_version(start, name, option):
    # conforms: gzserver/-h, gzserver/-v, gzclient/-h, gzclient/-v
    process = start(name, option)
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and name in said
    assert "v" not in option or f" {__version__}" in said


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_client_says_how_to_look_and_ends_with_0(start, number):
    # conforms: gzclient
    process = start("gzclient", "--verbose", "__name:=gazebo_gui")
    line = process.stdout.readline()
    assert "rosrun image_view image_view" in line and "rviz" in line
    assert Path(f"/proc/{process.pid}/comm").read_text() == "gzclient\n"
    process.send_signal(number)
    said, _ = process.communicate(timeout=60)
    assert (said, process.returncode) == ("", 0)


def test_the_client_ends_when_the_master_is_gone(start):
    master = socket.create_server(("localhost", 0))
    uri = f"http://localhost:{master.getsockname()[1]}"
    process = start("gzclient", ROS_MASTER_URI=uri)
    master.settimeout(60)
    master.accept()[0].close()
    assert process.poll() is None
    master.close()
    assert process.wait(60) == 0


def test_the_client_ends_when_roslaunch_was_killed():
    """Chaos: course, seed 101, kills roslaunch; the master is another terminal's and stays."""
    with socket.create_server(("localhost", 0)) as master:
        started = subprocess.Popen(
            ["sh", "-c", f"{sys.executable} {SCRIPTS / 'gzclient'} & exec sleep 1000"],
            env=os.environ | {"ROS_MASTER_URI": f"http://localhost:{master.getsockname()[1]}"},
            stdout=subprocess.PIPE, text=True, start_new_session=True)
        try:
            assert "image_view" in started.stdout.readline()
            started.kill()
            started.communicate(timeout=60)  # until nobody has its output open
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(started.pid, signal.SIGKILL)
