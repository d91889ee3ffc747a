#!/usr/bin/env python3
"""With lockstep_timeout 0 the world waits for as long as a program stands, and says for whom."""

import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from gazebo_msgs.srv import GetWorldProperties
from gzserver_process import LIMIT, Gzserver, wait_until
from lockstep_contract import END_LIMIT, FRAME_PERIOD, Follower
from std_srvs.srv import Empty

WAITS = "stands still until"
MISSED = "where nobody sends any more"
STAND = 3.0  # s, wall: longer than the usual time-out, and than what is caught up with
# A program that has taken an image and does not answer it.
STANDING = """
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

rospy.init_node("standing", disable_rostime=True)
commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
rospy.Subscriber("/eye/image_raw", Image, lambda image: print("image", flush=True))
rospy.spin()
"""


class Breakpoint(unittest.TestCase):
    def start(self, *options):
        server = Gzserver(*options, lockstep="/cmd_vel", lockstep_timeout=0)
        self.addCleanup(server.end)
        return server.wait_until_ready()

    def follow(self, **options):
        follower = Follower("/cmd_vel", **options)
        self.addCleanup(follower.close)
        return follower

    def time_of(self, server):
        return server.call("get_world_properties", GetWorldProperties).sim_time

    def test_it_waits_for_the_answer_and_goes_on_as_if_nothing_had_happened(self):
        server = self.start()  # in real time
        released = []

        def stand(number):
            wait_until(lambda: number != 3 or released, "the end of the breakpoint")
            return 0.0

        follower = self.follow(delay=stand)
        follower.wait_until_connected()
        server.call("unpause_physics", Empty)
        wait_until(lambda: WAITS in server.output(), "the line that says whom it waits for")
        self.assertIn(f"until {rospy.get_name()} sends on /cmd_vel", server.output())
        self.assertEqual(self.time_of(server), 0.15)
        self.assertEqual(len(follower.images), 3)
        released.append(True)
        began = time.monotonic()
        wait_until(lambda: self.time_of(server) > 0.6, "time that goes on")
        self.assertGreater(time.monotonic() - began, 0.4, "it caught up with the breakpoint")
        stamps = follower.stamps()
        self.assertEqual(stamps, [FRAME_PERIOD * (n + 1) for n in range(len(stamps))])
        self.assertEqual(server.output().count(WAITS), 1)
        self.assertNotIn("no message on", server.output())
        self.assertNotIn("simulated time runs at", server.output())

    def test_a_killed_program_is_missed_and_the_next_one_drives_on(self):
        server = self.start("--real_time_factor", "0")
        killed = subprocess.Popen([sys.executable, "-c", STANDING], stdout=subprocess.PIPE)
        self.addCleanup(killed.stdout.close)
        self.addCleanup(killed.kill)
        server.call("unpause_physics", Empty)
        self.assertEqual(killed.stdout.readline(), b"image\n")
        stood_at = self.time_of(server)
        killed.kill()
        killed.wait()
        wait_until(lambda: MISSED in server.output(), "the line that misses it")
        self.assertIn("rostopic pub -1 /cmd_vel geometry_msgs/Twist '{}'", server.output())
        self.assertEqual(self.time_of(server), stood_at)
        # It sees the image at which the world stands, and each later one, once.
        follower = self.follow()
        wait_until(lambda: len(follower.images) >= 20, "images for the next program")
        stamps = follower.stamps()
        first = round(stood_at * 1e9)
        self.assertEqual(stamps, [first + FRAME_PERIOD * n for n in range(len(stamps))])
        self.assertEqual(server.output().count(MISSED), 1)

    def test_one_message_by_hand_goes_on_without_the_program(self):
        server = self.start("--real_time_factor", "0")
        follower = self.follow(delay=lambda number: None)
        follower.wait_until_connected()
        server.call("unpause_physics", Empty)
        wait_until(lambda: follower.images, "an image")
        stood_at = self.time_of(server)
        self.assertEqual(stood_at, 0.05)
        subprocess.run(["rostopic", "pub", "-1", "/cmd_vel", "geometry_msgs/Twist", "{}"],
                       check=True, timeout=LIMIT, stdout=subprocess.DEVNULL)
        wait_until(lambda: len(follower.images) == 2, "the next image")
        time.sleep(STAND)  # the usual time-out would have been over
        self.assertEqual(len(follower.images), 2)
        code, took = server.end(signal.SIGINT)
        self.assertEqual(code, 0, server.output())
        self.assertLess(took, END_LIMIT)


if __name__ == "__main__":
    rospy.init_node("breakpoint_contract", disable_rostime=True)
    rostest.rosrun("bullet_sim_ros", "breakpoint", Breakpoint)
