#!/usr/bin/env python3
"""The laser's driver of the made-up robot: a process of its own, which can be killed."""

import rospy
from sensor_msgs.msg import LaserScan

if __name__ == "__main__":
    rospy.init_node("laser")
    scans = rospy.Publisher("scan", LaserScan, queue_size=1)
    rospy.Subscriber("sweeps", LaserScan, scans.publish, queue_size=1)
    rospy.spin()
