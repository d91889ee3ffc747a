"""gzserver as a process of a test's own, one after another under one name."""

import os
import signal
import subprocess
import tempfile
import time

import rospy
from roslib.packages import find_node

LIMIT = 60.0  # s, wall, for anything that a test waits for
NODE = "/gazebo"
WORLD = os.path.join(os.path.dirname(os.path.abspath(__file__)), "camera_robot.world")


def wait_until(condition, what, limit=LIMIT):
    """Poll on the wall clock: simulated time may stand still."""
    until = time.monotonic() + limit
    while not condition():
        if time.monotonic() > until:
            raise AssertionError(f"not within {limit} s: {what}")
        time.sleep(0.02)


class Gzserver:
    """Starts with `camera_robot.world`, paused; parameters are those below /gazebo."""

    def __init__(self, *options, **parameters):
        if rospy.has_param(NODE):
            rospy.delete_param(NODE)  # of the one before
        for name, value in parameters.items():
            rospy.set_param(f"{NODE}/{name}", value)
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  (as long as the process)
        self.process = subprocess.Popen(
            [find_node("gazebo_ros", "gzserver")[0], *options, "-u", WORLD],
            stdout=self._log, stderr=subprocess.STDOUT)

    def wait_until_ready(self):
        """Its services answer, its plugins are loaded."""
        wait_until(lambda: "is ready" in self.output() or self.process.poll() is not None, "start")
        assert self.process.poll() is None, self.output()
        return self

    def output(self):
        """What it has printed so far."""
        return os.pread(self._log.fileno(), 1_000_000, 0).decode()

    def call(self, name, kind, *arguments, **fields):
        """Call one of its services."""
        rospy.wait_for_service(f"{NODE}/{name}", LIMIT)
        return rospy.ServiceProxy(f"{NODE}/{name}", kind)(*arguments, **fields)

    def end(self, number=signal.SIGINT):
        """Tell it to end, and wait; returns its exit code and the seconds that it took."""
        began = time.monotonic()
        if self.process.poll() is None:
            self.process.send_signal(number)
        try:
            code = self.process.wait(LIMIT)
        finally:
            self.process.kill()
        assert "Traceback" not in self.output(), self.output()
        return code, time.monotonic() - began
