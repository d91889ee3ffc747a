"""Two runs of a node on one master: what was set for the first one is gone in the second."""

import contextlib
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import rospkg
import rospy
import yaml
from dynamic_reconfigure.client import Client
from roslib.packages import find_node

NODE = "/lane_follow"
LIMIT = 60  # s, wall


@contextlib.contextmanager
def sliders():
    """The node's settings as rqt_reconfigure has them."""
    client = Client(NODE, timeout=LIMIT)
    try:
        yield client
    finally:
        client.close()


def settings_now():
    with sliders() as client:
        return client.get_configuration(LIMIT)


class SettingsRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name, "mine.yaml")
        shipped = Path(rospkg.RosPack().get_path("car_control"), "config", "lane_follow.yaml")
        self.table = yaml.safe_load(shipped.read_text(encoding="utf-8"))
        rospy.set_param(NODE, {"ki": 0.7})  # the user's own, for every run

    def run_node(self, *arguments, **changes):
        """Start the node with these changes in its file."""
        self.file.write_text(yaml.safe_dump({**self.table, **changes}), encoding="utf-8")
        process = subprocess.Popen(
            (find_node("car_control", "lane_follow.py")[0], f"_config:={self.file}", *arguments)
        )
        self.addCleanup(process.wait, LIMIT)
        self.addCleanup(process.kill)
        return process

    def second_run_after(self, ending):
        first = self.run_node("_kp:=2.5", max_speed=1.9)
        before = settings_now()
        self.assertEqual((before["kp"], before["ki"], before["max_speed"]), (2.5, 0.7, 1.9))
        with sliders() as client:
            client.update_configuration({"kd": 0.25})
        self.assertEqual(settings_now()["kd"], 0.25)
        first.send_signal(ending)
        first.wait(LIMIT)
        self.assertEqual(rospy.get_param(NODE), {"ki": 0.7})
        self.run_node(max_speed=1.1)
        after = settings_now()
        for name, value in (("kp", self.table["kp"]), ("ki", 0.7), ("kd", self.table["kd"]),
                            ("max_speed", 1.1)):
            self.assertEqual(after[name], value, name)

    def test_nothing_stays_after_ctrl_c(self):
        self.second_run_after(signal.SIGINT)

    def test_nothing_stays_after_a_kill(self):
        self.second_run_after(signal.SIGKILL)
