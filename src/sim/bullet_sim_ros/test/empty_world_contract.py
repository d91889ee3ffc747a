#!/usr/bin/env python3
"""The contracts that begin in an empty world, one after another in one simulator."""

import rospy
import rostest
from robots_contract import Robots  # noqa: F401, rostest finds them by this module's name
from ros_control_contract import RosControl  # noqa: F401
from services_contract import Services  # noqa: F401

if __name__ == "__main__":
    rospy.init_node("empty_world_contract", disable_rostime=True)
    rostest.rosrun("bullet_sim_ros", "empty_world", "__main__")
