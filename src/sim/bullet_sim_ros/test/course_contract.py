#!/usr/bin/env python3
"""The contracts of the course with the waffle, one after another in one simulator."""

import rospy
import rostest
from topic_faults_contract import TopicFaults  # noqa: F401, rostest finds them by this module's name
from waffle_contract import Waffle  # noqa: F401

if __name__ == "__main__":
    rospy.init_node("course_contract")
    rostest.rosrun("bullet_sim_ros", "course", "__main__")
