"""roslaunch bringup racecar_gazebo.launch: the car comes up on the start line."""

import unittest

import numpy as np
import rospy
from acceptance_car import LIMIT, Truth
from sensor_msgs.msg import Image


class Bringup(unittest.TestCase):
    def test_the_car_stands_on_the_start_line_and_sees(self):
        truth = Truth()
        truth.time_until_standing(truth.now.time)
        here = truth.now
        np.testing.assert_allclose((here.x, here.y, here.z, here.yaw), 0.0, atol=2e-3)
        image = rospy.wait_for_message("/camera/image_raw", Image, LIMIT)
        self.assertEqual((image.width, image.height), (1280, 720))
