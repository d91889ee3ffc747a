#!/usr/bin/env python3
"""Says hello on /chatter ten times a second.  每秒十次在 /chatter 上发布一句话。"""

import rospy
from std_msgs.msg import String

RATE_HZ = 10


def main():
    publisher = rospy.Publisher("chatter", String, queue_size=10)
    rospy.init_node("talker", anonymous=True)  # so that two talkers can run  可以同时运行多个
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        text = f"hello world {rospy.get_time()}"
        rospy.loginfo(text)
        publisher.publish(text)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
