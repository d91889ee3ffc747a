"""Refuses a launch file whose simulator runs already, while roslaunch still reads the file.

Later would be too late: roslaunch sets all parameters and starts all nodes at once, which would
replace the first launch's robot_description and robot_state_publisher. So empty_world.launch has
this program print the value of a parameter: if it fails, roslaunch ends with exit code 1.
"""

import contextlib
import io
import os
import re
import sys
from pathlib import Path

from node_basics.listening import listens
from node_basics.refusing import REFUSED

from bullet_sim_ros.already_running import may_simulate

_OWN_PORT = re.compile(r"(?:^| )(?:-p|--port)[ =]?(\d+)")  # of roslaunch's master
SERVERS = ("gzserver", "gazebo", "debug", "perf")  # of gazebo_ros


def main() -> int:
    """Print the arguments, or one line on stderr; returns the exit code."""
    refused = refusal_of(_command_line(os.getppid()))
    if refused:
        print(refused, file=sys.stderr)
        return REFUSED
    sys.stdout.write(" ".join(sys.argv[1:]))
    return 0


def refusal_of(command: list[str]) -> str:
    """Why what this roslaunch command starts must not start; "" if it may, or is something else.

    rostest and others choose their master only after they have read the file: they are let pass,
    and the node notices by itself.
    """
    words = next((command[at + 1:] for at, word in enumerate(command[:2])
                  if Path(word).name == "roslaunch"), None)
    if words is None:
        return ""
    own_port = _OWN_PORT.search(" ".join(words))
    uri = f"http://localhost:{own_port[1]}" if own_port else os.environ.get("ROS_MASTER_URI", "")
    if not (listens(uri) and may_simulate(uri)):
        return ""
    # Only now, as these take half a second to load.
    import roslaunch
    from roslaunch.core import RLException
    from rospkg import ResourceNotFound

    from bullet_sim_ros.only_simulator import refusal

    options, files = roslaunch._get_optparse().parse_args(words)
    if any((options.node_args, options.node_list, options.find_node, options.dump_params,
            options.file_list, options.ros_args)) or "-" in files:
        return ""
    try:
        refused = [refusal(uri, name) for name in simulators_of(files, command)]
    except (OSError, RLException, ResourceNotFound, ValueError):
        return ""  # no master; or a fault of the file, which roslaunch reports itself
    return next((form % tuple(what) for form, *what in filter(None, refused)), "")


def simulators_of(files: list[str], command: list[str]) -> list[str]:
    """Full names of the simulators that launch files start, with the arguments in `command`.

    RLException if a file cannot be read.
    """
    from rosgraph.names import ns_join
    from roslaunch import rlutil
    from roslaunch.config import ROSLaunchConfig
    from roslaunch.xmlloader import XmlLoader

    class Reader(XmlLoader):
        """Leaves out the values of parameters: commands that make them take time."""

        def param_value(self, *_: object) -> str:
            return ""

    config = ROSLaunchConfig()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        for file in rlutil.resolve_launch_arguments(files):
            Reader().load(file, config, argv=command, verbose=False)
    return [ns_join(node.namespace, node.name) for node in config.nodes
            if node.package == "gazebo_ros" and node.type in SERVERS]


def _command_line(process: int) -> list[str]:
    words = Path(f"/proc/{process}/cmdline").read_bytes().split(b"\0")
    return [word.decode(errors="replace") for word in words[:-1]]
