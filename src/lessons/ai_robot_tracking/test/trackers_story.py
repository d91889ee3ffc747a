#!/usr/bin/env python3
"""What makes the trackers stand: bad images, none at all, e-stop, their end, however it comes."""

import signal
import subprocess
import sys
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from roslib.packages import find_node
from spoiling_relay import (
    BLANK,
    FROZEN,
    GOOD,
    LIMIT,
    NONE,
    WRONG_STEP,
    SpoilingRelay,
    wait_until,
)
from std_msgs.msg import Bool

STANDS_WITHIN = 0.7  # s, simulated, after kill -9
SAID = {BLANK: "blank", FROZEN: "frozen", WRONG_STEP: "step", NONE: "no fresh image"}


def start(script, *arguments):
    return subprocess.Popen([find_node("ai_robot_tracking", script)[0], *arguments],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


class TrackersStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.relay = SpoilingRelay()
        cls.stop = rospy.Publisher("/e_stop", Bool, queue_size=1)
        wait_until(lambda: cls.relay.time > 0, "the car")

    def setUp(self):
        self.relay.spoil(GOOD)
        self.node = None

    def tearDown(self):
        if self.node is not None:
            self.node.kill()
            self.node.wait()
            self.node.stdout.close()

    def drive(self, script):
        self.node = start(script, "camera/rgb/image_raw:=/relay/image_raw")
        self.wait_for_driving()

    def wait_for_driving(self):
        wait_until(lambda: self.relay.moves, "driving")

    def wait_for_standing(self, why):
        wait_until(lambda: self.relay.stands, f"standing: {why}")

    def check_bad_images(self, modes):
        for mode, word in ((each, SAID[each]) for each in modes):
            self.relay.said.clear()
            self.relay.spoil(mode)
            wait_until(lambda w=word: self.relay.warnings([w, "/relay/image_raw"]), f"{mode} said")
            self.wait_for_standing(mode)
            self.relay.spoil(GOOD)
            self.wait_for_driving()

    def check_e_stop(self):
        self.stop.publish(True)
        self.wait_for_standing("e-stop")
        self.stop.publish(False)
        self.wait_for_driving()

    def check_kill(self):
        process = self.node.pid
        self.wait_for_driving()
        killed = self.relay.time
        subprocess.run(["kill", "-9", str(process)], check=True)
        self.wait_for_standing("killed")
        self.assertLess(self.relay.time - killed, STANDS_WITHIN)

    def test_1_plain_tracker(self):
        self.drive("visual_tracker.py")
        self.check_bad_images((BLANK, WRONG_STEP, NONE))
        self.check_e_stop()
        self.check_kill()

    def test_2_pid_tracker(self):
        self.drive("visual_tracker_pid.py")
        self.check_bad_images(SAID)
        self.check_e_stop()
        client = Client("visual_tracker_pid", timeout=LIMIT)
        still = {"max_speed": 0.0, "max_reverse": 0.0, "max_turn": 0.0, "search_turn": 0.0}
        client.update_configuration(still)
        self.wait_for_standing("all speeds set to 0")
        client.update_configuration(
            {"max_speed": 0.6, "max_reverse": 0.5, "max_turn": 1.5, "search_turn": 0.8})
        self.wait_for_driving()
        client.close()
        self.check_kill()

    def test_3_ctrl_c_leaves_the_car_standing(self):
        self.drive("visual_tracker.py")
        self.node.send_signal(signal.SIGINT)
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.wait_for_standing("Ctrl-C")

    def test_4_a_wrong_parameter_is_one_line(self):
        for script, names in (("visual_tracker_pid.py", "unknown key 'kp_trun'"),
                              ("visual_tracker.py", "unknown parameter, or no number: 'kp_trun'")):
            node = start(script, "_kp_trun:=1.0", "__name:=mistyped")
            said, _ = node.communicate(timeout=LIMIT)
            self.assertEqual(node.returncode, 1)
            self.assertIn(names, said)
            self.assertFalse(rospy.has_param("/mistyped/kp_trun"), "it would stay for the next run")
            self.assertNotIn("Traceback", said)
        for one in ("", "/file", "/file/visual_tracker"):
            rospy.set_param(f"/mistyped{one}", 5)
            said, _ = start("visual_tracker.py", "__name:=mistyped").communicate(timeout=LIMIT)
            self.assertIn("unknown parameter, or no number: '~'", said)
            self.assertNotIn("Traceback", said)

    def test_5_a_launch_files_parameters_are_there_for_a_node_that_is_started_again(self):
        given = {"file": {"visual_trackr": {"fast_speed": 0.1}}}
        rospy.set_param("/kept", given)
        self.node = start("visual_tracker.py", "__name:=kept", "_slow_speed:=0.2")
        self.assertIn("no section visual_tracker: the page's numbers", self.node.stdout.readline())
        self.assertEqual(rospy.get_param("/kept"), given)


if __name__ == "__main__":
    rospy.init_node("trackers_test")
    rostest.rosrun("ai_robot_tracking", "trackers_story", TrackersStory, sys.argv)
