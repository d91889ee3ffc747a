#!/usr/bin/env python3
"""Drives the car with the keys W, A, S and D, in a window or (--terminal) in a plain terminal."""

import argparse
import importlib
import sys
import time
from dataclasses import dataclass

import rospy
from car_control.key_terminal import run_terminal
from car_control.keys import Pace, command
from car_control.master_watch import MasterWatch
from car_control.node import Ending, read_settings, start_node
from geometry_msgs.msg import Twist
from node_basics.settings import number

FLUSH_TIME = 0.2  # s: rospy's threads need this to send before the process ends
IN_TERMINAL = "rosrun car_control keyboard_control.py --terminal"
PAGE = "roslaunch sim_viewer viewer.launch control:=true"


@dataclass(frozen=True)
class KeySettings:
    """Settings of the node key_control."""

    speed: float = number(0, 20, "m/s while W or S is held")
    max_steering_angle: float = number(0, 1.2, "rad while A or D is held")


class KeyControl:
    """Publishes the keys' commands. A window's or terminal's run(turn) delivers the keys."""

    def __init__(self, settings):
        self.settings, self.pace = settings, Pace()
        self.publisher = rospy.Publisher("motor_output", Twist, queue_size=10)
        self.master = MasterWatch(rospy.get_name())
        self.ending = Ending()

    def turn(self, keys):
        """Publish if due; returns a line with the command, or None at the end."""
        if self.ending.asked.is_set() or self.master.gone:
            return None
        speed, angle = command(keys, self.settings.speed, self.settings.max_steering_angle)
        if self.pace.due((speed, angle), time.monotonic()):
            self.publish(speed, angle)
        return f"{speed:+.2f} m/s  {angle:+.2f} rad" if keys else "the car stands"

    def publish(self, speed, angle):
        message = Twist()
        message.linear.x, message.angular.z = speed, angle
        self.publisher.publish(message)

    def stop(self):
        """Stop the car if this node has driven it."""
        if self.pace.sent != (0.0, 0.0):
            self.publish(0.0, 0.0)
            time.sleep(FLUSH_TIME)
        self.ending.done()


def open_keys(in_terminal):
    """run(turn) of the terminal or of a new window; exits with one line if there is neither."""
    if in_terminal:
        if not sys.stdin.isatty():
            sys.exit("keyboard_control: no terminal to read keys from. Type it in a terminal, "
                     f"without <, | or & beside it; or use the page's tab Drive: {PAGE}")
        return lambda turn: run_terminal(sys.stdin.fileno(), turn)
    try:
        key_window = importlib.import_module("car_control.key_window")  # imports Tk
    except ImportError as error:
        sys.exit(f"keyboard_control: {error}; type: sudo apt-get install python3-tk")
    try:
        return key_window.KeyWindow().run
    except key_window.NoScreen as error:
        sys.exit(f"keyboard_control: no screen to open a window on ({error}); type: {IN_TERMINAL}; "
                 f"or make drive, which starts the car, too; or use the page's tab Drive: {PAGE}")


def main():
    parser = argparse.ArgumentParser(prog="keyboard_control.py", description=__doc__)
    parser.add_argument("--terminal", action="store_true", help="keys from this terminal")
    run = open_keys(parser.parse_args(rospy.myargv()[1:]).terminal)
    start_node("key_control")
    control = KeyControl(read_settings(KeySettings, "car_control.yaml", "key_control"))
    try:
        run(control.turn)
    finally:
        control.stop()
    if control.master.gone:
        sys.exit(f"keyboard_control: the ROS master at {control.master.uri} has ended")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:  # while the node was still waiting for its master
        sys.exit(130)
