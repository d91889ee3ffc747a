#!/usr/bin/env python3
"""Random numbers around 5 on /random_number, 20 a second.  每秒二十个 5 左右的随机数。"""

import random

import rospy
from std_msgs.msg import Float32

MEAN, DEVIATION = 5, 1
PERIOD = 0.05  # s


def main():
    publisher = rospy.Publisher("random_number", Float32, queue_size=10)
    rospy.init_node("random_number_generator")
    rospy.loginfo("Generating random numbers")
    while not rospy.is_shutdown():
        publisher.publish(random.normalvariate(MEAN, DEVIATION))
        rospy.sleep(PERIOD)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
