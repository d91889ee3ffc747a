#!/usr/bin/env python3
"""multisim.launch's names, and mimic, which carries one turtle's speeds to the other."""

import sys
import unittest

import rosnode
import rospy
import rostest
from geometry_msgs.msg import Twist
from pond_watch import Topic, service_names, wait_until
from turtlesim.msg import Pose


class MultisimStory(unittest.TestCase):
    def test_nodes_and_services_are_in_their_namespaces(self):
        wait_until(lambda: {"/turtlesim1/spawn", "/turtlesim2/spawn"} <= service_names(), "spawn")
        nodes = {"/turtlesim1/sim", "/turtlesim2/sim", "/mimic"}
        wait_until(lambda: nodes <= set(rosnode.get_node_names()), "nodes")
        self.assertTrue(rospy.has_param("/turtlesim1/sim/background_r"))

    def test_the_second_turtle_does_as_the_first(self):
        second = Topic("/turtlesim2/turtle1/pose", Pose)
        command = rospy.Publisher("/turtlesim1/turtle1/cmd_vel", Twist, queue_size=1)
        wait_until(lambda: command.get_num_connections(), "the first pond")
        mimicked = Topic("/turtlesim2/turtle1/cmd_vel", Twist)
        mimicked.wait_for(lambda _: True, "mimic's command")
        message = Twist()
        message.linear.x, message.linear.y, message.angular.z = 0.6, 0.8, -1.5
        # Again and again: mimic's link to the second pond may come later than that to us.
        driver = rospy.Timer(rospy.Duration(0.1), lambda _: command.publish(message))
        self.addCleanup(driver.shutdown)
        copied = mimicked.wait_for(lambda m: m.linear.x > 0, "mimic's moving command")
        self.assertAlmostEqual(copied.linear.x, 1.0, places=6)
        self.assertEqual((copied.linear.y, copied.angular.z), (0.0, -1.5))
        second.wait_for(lambda p: p.angular_velocity == -1.5 and p.linear_velocity > 0, "mimicry")


if __name__ == "__main__":
    rospy.init_node("multisim_story")
    rostest.rosrun("turtlesim", "multisim_story", MultisimStory, sys.argv)
