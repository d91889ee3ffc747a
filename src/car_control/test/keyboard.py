"""Runs keyboard_control.py for tests, and keeps what it publishes."""

import os
import signal
import subprocess
import threading
import time

import rospy
from fake_controllers import LIMIT
from geometry_msgs.msg import Twist
from roslib.packages import find_node

NODE = (find_node("car_control", "keyboard_control.py")[0],)


class Sent:
    """The commands on motor_output, as (m/s, rad), in the order of arrival."""

    def __init__(self):
        self.commands, self.arrived = [], threading.Condition()
        self.subscriber = rospy.Subscriber("motor_output", Twist, self.keep, queue_size=100)

    def keep(self, message):
        with self.arrived:
            self.commands.append((message.linear.x, message.angular.z))
            self.arrived.notify_all()

    def forget(self):
        with self.arrived:
            self.commands.clear()

    def wait_for(self, wanted):
        """Until the last command is this one."""
        with self.arrived:
            came = self.arrived.wait_for(
                lambda: self.commands and self.commands[-1] == wanted, LIMIT
            )
        assert came, f"{wanted} was not sent; the last were {self.commands[-3:]}"

    def wait_for_number(self, number):
        with self.arrived:
            came = self.arrived.wait_for(lambda: len(self.commands) >= number, LIMIT)
        assert came, f"not {number} commands, only {self.commands}"

    def wait_for_silence(self, seconds=0.5):
        """Until nothing was sent for so long."""
        end = time.monotonic() + LIMIT
        with self.arrived:
            while self.arrived.wait(seconds):
                assert time.monotonic() < end, f"never silent; {self.commands[-3:]}"


def start_node(*arguments, **options):
    """keyboard_control.py in a session of its own."""
    return subprocess.Popen([*NODE, *arguments], start_new_session=True, **options)


def end_node(node):
    """Kill what is left of it."""
    if node.poll() is None:
        os.killpg(node.pid, signal.SIGKILL)
    node.wait()
