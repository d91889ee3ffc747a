#!/usr/bin/env python3
"""rviz finds the marker and its controls; dragged, it drives."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit

LIMIT = 60.0  # s, for whatever is waited for


class DragMarker(unittest.TestCase):
    def test_dragged_it_drives(self):
        init = rospy.wait_for_message("/twist_marker_server/update_full", InteractiveMarkerInit,
                                      LIMIT)
        (marker,) = init.markers
        self.assertEqual((marker.name, marker.header.frame_id),
                         ("robot_twist_marker", "base_link"))
        self.assertEqual([c.name for c in marker.controls], ["move_x", "move_y", "rotate_z"])
        feedback = InteractiveMarkerFeedback(marker_name=marker.name, client_id="test",
                                             event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        feedback.header.frame_id = "base_link"
        feedback.pose.position.x, feedback.pose.position.y = 0.5, -0.25
        feedback.pose.orientation.w = 1.0
        publisher = rospy.Publisher("/twist_marker_server/feedback", InteractiveMarkerFeedback,
                                    queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.1), lambda _: publisher.publish(feedback))
        command = rospy.wait_for_message("/twist_marker_server/cmd_vel", Twist, LIMIT)
        timer.shutdown()
        self.assertEqual((command.linear.x, command.linear.y), (0.5, -0.25))


if __name__ == "__main__":
    rospy.init_node("drag_marker")
    rostest.rosrun("interactive_marker_twist_server", "drag_marker", DragMarker, sys.argv)
