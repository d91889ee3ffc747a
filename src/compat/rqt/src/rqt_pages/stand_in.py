"""One line that says where a window's work is done here; in a launch file it stays until Ctrl-C."""

import argparse
import os
import signal
import sys
import threading
from collections.abc import Sequence

PAGE = "roslaunch sim_viewer viewer.launch"
DRIVING = f"{PAGE} control:=true"
RVIZ_PAGE = "rosrun sim_viewer rviz_page -d"

# What does the work of each tool: the tab of the page, or a command to type.
TABS = {"rqt_graph": "Graph", "rqt_plot": "Plot", "rqt_multiplot": "Plot",
        "rqt_image_view": "Cameras", "rqt_console": "Console", "rqt_tf_tree": "TF",
        "rqt_bag": "Bags", "rqt_topic": "Topics", "rqt_robot_monitor": "Topics", "rqt_rviz": "RViz",
        "rviz": "RViz", "image_view": "Cameras", "stereo_view": "Cameras",
        "disparity_view": "Cameras",
        "rqt_robot_steering": "Drive", "rqt_service_caller": "Services"}
CONTROLS = ("rqt_robot_steering", "rqt_service_caller", "rqt_bag")  # tabs that change something
COMMANDS = {
    "rqt_reconfigure": "rosrun dynamic_reconfigure dynparam set NODE PARAMETER VALUE",
    "rqt_publisher": "rostopic pub -r 10 TOPIC TYPE VALUES",
    "rqt_logger_level": "rosservice call /NODE/set_logger_level ros.NODE debug",
    "rqt_controller_manager": "rosrun controller_manager controller_manager list",
    "rqt_joint_trajectory_controller":
        "rostopic pub -1 /CONTROLLER/command trajectory_msgs/JointTrajectory VALUES"}


def line_for(tool: str, arguments: Sequence[str]) -> str:
    """What is printed for `tool`; `rqt -s rqt_plot` and the like name another one."""
    named = [word.split(".")[0].split("/")[0] for word in arguments if word.startswith("rqt_")]
    tool = next((name for name in named if name in TABS or name in COMMANDS), tool)
    if tool in COMMANDS:
        return f"{tool} has no window here. Type: {COMMANDS[tool]}"
    page = DRIVING if tool in CONTROLS else PAGE
    if TABS.get(tool) == "RViz" and (file := _display_config(arguments)):
        page = f"{RVIZ_PAGE} {file}"
    if tool in TABS:
        return (f"{tool} has no window here; the page in the browser does its work, "
                f"tab {TABS[tool]}. Type: {page}")
    return f"{tool} has no window here; the page in the browser does its work. Type: {page}"


def _display_config(arguments: Sequence[str]) -> str:
    """The file that rviz's command line names, or nothing."""
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("-d", "--display-config", default="")
    return parser.parse_known_args(arguments)[0].display_config


def window(tool: str, program: str, arguments: Sequence[str]) -> int:
    """Become Debian's `program` where there is a screen; otherwise as `main`."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        os.execv(program, [program, *arguments])
    return main(tool, arguments)


def main(tool: str, arguments: Sequence[str]) -> int:
    """Print the line; returns 1, as there is no window.

    As a node of a launch file it waits until it is ended, and returns 0: if it ended at once, a
    `required` node would end the launch.
    """
    print(line_for(tool, arguments), file=sys.stderr, flush=True)
    if not any(word.startswith("__name:=") for word in arguments):
        return 1
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    ended.wait()
    return 0
