#!/usr/bin/env python3
"""Publishes strings with a time stamp.  发布带时间戳的字符串。"""

import rospy
from rospy_tutorials.msg import HeaderString

RATE_HZ = 10


def main():
    publisher = rospy.Publisher("chatter_header", HeaderString, queue_size=10)
    rospy.init_node("talker_header", anonymous=True)
    rate = rospy.Rate(RATE_HZ)
    count = 0
    while not rospy.is_shutdown():
        message = HeaderString(data=f"hello world {count}")
        message.header.stamp = rospy.Time.now()  # header.seq is rospy's  序号由 rospy 填写
        rospy.loginfo(message.data)
        publisher.publish(message)
        count += 1
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
