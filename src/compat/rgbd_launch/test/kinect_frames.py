#!/usr/bin/env python3
"""The colour camera looks ahead, 4.5 cm to the right of the middle."""

import sys
import unittest

import rospy
import rostest
import tf2_ros


class KinectFrames(unittest.TestCase):
    def test_colour_camera(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        found = buffer.lookup_transform("camera_link", "camera_rgb_optical_frame", rospy.Time(0),
                                        rospy.Duration(60.0)).transform
        listener.unregister()
        place, turn = found.translation, found.rotation
        self.assertEqual([round(v, 6) for v in (place.x, place.y, place.z)], [0.0, -0.045, 0.0])
        self.assertEqual([round(v, 6) for v in (turn.x, turn.y, turn.z, turn.w)],
                         [-0.5, 0.5, -0.5, 0.5])


if __name__ == "__main__":
    rospy.init_node("kinect_frames")
    rostest.rosrun("rgbd_launch", "kinect_frames", KinectFrames, sys.argv)
