#!/usr/bin/env python3
"""Lesson 1's node is called /follower and is connected to the camera."""

import sys
import unittest

import rosgraph
import rospy
import rostest
from stand_in_camera import StandInCamera, wait_until


class Lesson01(unittest.TestCase):
    def test_is_connected_to_the_camera(self):
        camera = StandInCamera(320)
        wait_until(lambda: camera.publisher.get_num_connections() > 0, "a subscriber")
        _pubs, subscribed, _services = rosgraph.Master(rospy.get_name()).getSystemState()
        self.assertIn("/follower", dict(subscribed)["/camera/rgb/image_raw"])


if __name__ == "__main__":
    rospy.init_node("lesson_01_subscribes")
    rostest.rosrun("learning_topic", "lesson_01", Lesson01, sys.argv)
