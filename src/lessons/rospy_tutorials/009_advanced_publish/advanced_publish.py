#!/usr/bin/env python3
"""Three ways to fill in a message, and how many listen.  填写消息的几种方法，以及有几个订阅者。"""

import rospy
from std_msgs.msg import ColorRGBA


def main():
    publisher = rospy.Publisher("color", ColorRGBA, queue_size=10)
    rospy.init_node("color_talker", anonymous=True)
    print(f"Node running. To see messages, please type\n\trostopic echo {publisher.resolved_name}"
          "\nin another window", flush=True)
    while not rospy.is_shutdown():
        publisher.publish(1, 2, 3, 4)  # all fields, in order  按顺序给出所有字段
        rospy.sleep(0.5)
        publisher.publish(a=1.0)  # the others are 0  其余字段为 0
        rospy.sleep(0.5)
        publisher.publish(ColorRGBA(1, 0, 0, 1))  # a message  一条消息
        rospy.sleep(0.5)
        rospy.loginfo("I have %s subscribers", publisher.get_num_connections())


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
