#!/usr/bin/env python3
"""Prints strings with the time at which they were sent.  打印字符串和它的发送时间。"""

import rospy
from rospy_tutorials.msg import HeaderString


def heard(message):
    rospy.loginfo("%s %d I just heard that %s at %12f", rospy.get_caller_id(),
                  message.header.seq, message.data, message.header.stamp.to_sec())


def main():
    rospy.init_node("listener_header", anonymous=True)
    rospy.Subscriber("chatter_header", HeaderString, heard)
    rospy.spin()


if __name__ == "__main__":
    main()
