#!/usr/bin/env python3
"""Prints what is said on /chatter.  打印 /chatter 上的每一句话。"""

import rospy
from std_msgs.msg import String


def heard(message):
    """Called for each message, in a thread of the subscriber's.  每条消息调用一次。"""
    rospy.loginfo(rospy.get_caller_id() + "I heard %s", message.data)


def main():
    rospy.init_node("listener", anonymous=True)
    rospy.Subscriber("chatter", String, heard)
    rospy.spin()


if __name__ == "__main__":
    main()
