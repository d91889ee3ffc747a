#!/usr/bin/env python3
"""Read the messages in test.bag.  读出 test.bag 里的消息。"""

import sys

import rosbag
import rospy

FILE = "test.bag"  # unless another is named  也可在命令行指定
TOPIC = "chatter"


def main():
    rospy.init_node("read_bag")
    try:
        with rosbag.Bag(*(rospy.myargv(sys.argv)[1:2] or [FILE])) as bag:
            # The time at which the message was written.  时间是写入的时刻
            for topic, message, time in bag.read_messages(topics=[TOPIC]):
                rospy.loginfo("%.3f %s: %s", time.to_sec(), topic, message.data)
    except (OSError, rosbag.ROSBagException) as error:
        sys.exit(f"read_bag.py: {error}: run write_bag.py here first, which writes {FILE}")


if __name__ == "__main__":
    main()
