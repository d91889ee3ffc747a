#!/usr/bin/env python
import rospy
from dynamic_reconfigure.server import Server
from shape_reconfigure.cfg import SpeedConfig


def change(config, level):
    rospy.loginfo("speed %.2f", config.speed)
    return config


rospy.init_node("shape_speed")
server = Server(SpeedConfig, change)
rospy.spin()
