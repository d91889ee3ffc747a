"""Turns a gzserver command line into one of the simulator node, and becomes that node."""

import argparse
import os
import shlex
import sys
from pathlib import Path

from bullet_sim import __version__

ABOUT = "PyBullet behind Gazebo 11's ROS interface"
SWITCHES_WITHOUT_EFFECT = (
    ("-r", "--record"), ("--record_resources",), ("--lockstep",), ("--minimal_comms",))
VALUES_WITHOUT_EFFECT = (
    ("-p", "--play"), ("--record_encoding",), ("--record_path",), ("--record_period",),
    ("--record_filter",), ("-s", "--server-plugin"), ("-o", "--profile"), ("-g",))


def parser(program: str) -> argparse.ArgumentParser:
    """Gazebo 11's server options."""
    result = argparse.ArgumentParser(
        prog=program, description=f"The simulator: {ABOUT}.", allow_abbrev=False)
    result.add_argument("world", nargs="?", default="worlds/empty.world", help="world file")
    result.add_argument("-v", "--version", action="version",
                        version=f"{program} {__version__}: {ABOUT}")
    result.add_argument("--verbose", action="store_true", help="log more")
    result.add_argument("-u", "--pause", action="store_true", help="start paused")
    result.add_argument("-e", "--physics", default="ode", help="physics engine")
    result.add_argument("--seed", metavar="N", help="seed of all random numbers")
    result.add_argument("--real_time_factor", metavar="F",
                        help="1: real time, 0: no limit; not an option of Gazebo's")
    result.add_argument("--initial_sim_time", metavar="S", help="time to start at, s")
    result.add_argument("--iters", metavar="N", help="stop after N steps")
    unused = result.add_argument_group("accepted, no effect")
    for names in SWITCHES_WITHOUT_EFFECT:
        unused.add_argument(*names, action="store_true")
    for names in VALUES_WITHOUT_EFFECT:
        unused.add_argument(*names, metavar="X")
    return result


def node_arguments(program: str, words: list[str]) -> list[str]:
    """The simulator node's arguments; unknown options are dropped, ROS remappings come last."""
    remappings = [word for word in words if ":=" in word]
    options, _ = parser(program).parse_known_args([word for word in words if ":=" not in word])
    result = ["--world", options.world, "--physics", options.physics]
    result += ["--paused"] if options.pause else []
    result += ["--verbose"] if options.verbose else []
    for name in ("seed", "iters", "initial_sim_time", "real_time_factor"):
        value = getattr(options, name)
        if value is not None:
            result.append(f"--{name.replace('_', '-')}={value}")
    return result + remappings


def main(python_options: tuple[str, ...] = (), hint: str = "") -> None:
    """Replace this process, so that signals reach the simulator itself; print `hint` first."""
    program = os.path.basename(sys.argv[0])
    arguments = node_arguments(program, sys.argv[1:])
    if hint:
        print(f"[{program}] {hint}", flush=True)
    # -P: a learner's file in the current folder must not hide a module. -X takes any word:
    # pkill -f gzserver finds this one.
    python = [sys.executable, "-P", "-X", "gzserver", *python_options, "-m", "bullet_sim_ros"]
    os.execv(sys.executable, [*python, *arguments])


def launch() -> None:
    """Become roslaunch with this command line's world and the page; it starts a missing master."""
    words = sys.argv[1:]
    options, _ = parser("gazebo").parse_known_args([word for word in words if ":=" not in word])
    from bullet_sim_ros.package_paths import unreadable_world  # its imports would delay gzserver

    if unreadable := unreadable_world(options.world):  # roslaunch would end with 0
        sys.exit(f"[FATAL] {unreadable}")
    # roslaunch starts nodes in another folder
    words = [str(Path(word).resolve()) if Path(word).is_file() else word for word in words]
    os.execvp("roslaunch", [
        "roslaunch", "gazebo_ros", "empty_world.launch", "gui:=false", "viewer:=true",
        "server_required:=true", f"extra_gazebo_args:={shlex.join(words)}"])
