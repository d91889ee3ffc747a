#!/usr/bin/env python3
"""Tom is published and received, and the turtle is told to drive in a circle."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Log
from stand_in_camera import LIMIT, wait_until

from learning_topic.msg import Person


class Publishers(unittest.TestCase):
    def test_person_arrives(self):
        person = rospy.wait_for_message("/person_info", Person, LIMIT)
        self.assertEqual((person.name, person.age, person.sex), ("Tom", 18, Person.male))
        self.assertEqual((Person.unknown, Person.male, Person.female), (0, 1, 2))

    def test_the_subscriber_says_what_it_received(self):
        said = []
        rospy.Subscriber("/rosout", Log, lambda msg: said.append((msg.name, msg.msg)))
        line = ("/person_subscriber", "received: Tom, age 18, sex 1")
        wait_until(lambda: line in said, line)

    def test_velocity(self):
        command = rospy.wait_for_message("/turtle1/cmd_vel", Twist, LIMIT)
        self.assertEqual((command.linear.x, command.angular.z), (0.5, 0.2))


if __name__ == "__main__":
    rospy.init_node("publishers_publish")
    rostest.rosrun("learning_topic", "publishers", Publishers, sys.argv)
