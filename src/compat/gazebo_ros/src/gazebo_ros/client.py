"""Stands in for Gazebo's window: says once how to look at the world, then waits for the end."""

import argparse
import ctypes
import os
import signal
import sys
import time

from node_basics.listening import listens

from bullet_sim import __version__

HOW_TO_LOOK = (
    "No 3D window here. See the world in the browser: roslaunch sim_viewer viewer.launch, "
    "then open http://127.0.0.1:8080/ (viewer:=true starts both at once). On a screen also: "
    "rosrun image_view image_view image:=TOPIC (of rostopic list); rviz"
)
POLL_PERIOD = 2.0  # s
PR_SET_NAME = 15  # of prctl(2)


def main() -> None:
    """No ROS node on purpose: one would be handed every /clock message."""
    parent = os.getppid()  # before anybody is told anything
    ctypes.CDLL(None).prctl(PR_SET_NAME, b"gzclient")  # for killall and pgrep
    parser = argparse.ArgumentParser(prog="gzclient", description=HOW_TO_LOOK)
    parser.add_argument("-v", "--version", action="version",
                        version=f"gzclient {__version__}: no window")
    parser.parse_known_args([word for word in sys.argv[1:] if ":=" not in word])
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: sys.exit(0))
    print(f"[gzclient] {HOW_TO_LOOK}", flush=True)
    master, seen = os.environ.get("ROS_MASTER_URI", "http://localhost:11311"), False
    while os.getppid() == parent and ((there := listens(master)) or not seen):
        seen |= there
        time.sleep(POLL_PERIOD)
