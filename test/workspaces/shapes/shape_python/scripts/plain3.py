#!/usr/bin/env python3
import cv2
import numpy
import pybullet
import rospy
from cv_bridge import CvBridge
from shape_msgs.msg import Reading
from shape_python.arithmetic import doubled

CvBridge().cv2_to_imgmsg(numpy.zeros((2, 2, 3), numpy.uint8), "bgr8")
print(doubled(Reading(value=21.0).value), cv2.__version__, pybullet.__name__, rospy.__name__)
