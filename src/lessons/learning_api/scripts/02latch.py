#!/usr/bin/env python3
"""latch: later subscribers get the last message too.  晚到的订阅者也能收到最后一条消息。"""

import rospy
from std_msgs.msg import String


def main():
    rospy.init_node("latch")
    publisher = rospy.Publisher("map_name", String, latch=True, queue_size=1)
    publisher.publish("house")  # once; nobody listens yet  只发一次
    rospy.loginfo("published once: house")
    rospy.spin()


if __name__ == "__main__":
    main()
