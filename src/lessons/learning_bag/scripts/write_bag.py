#!/usr/bin/env python3
"""Write three messages to test.bag.  把三条消息写入 test.bag。"""

import sys

import rosbag
import rospy
from std_msgs.msg import String

FILE = "test.bag"  # in the current folder; overwritten if it exists  写在当前目录，会覆盖
TOPIC = "chatter"


def main():
    rospy.init_node("write_bag")
    # `with` closes the file, which writes the index that reading needs.  不关闭则没有索引
    try:
        with rosbag.Bag(FILE, "w") as bag:
            for count in range(3):
                bag.write(TOPIC, String(data=f"hello {count}"))
    except OSError as error:
        sys.exit(f"write_bag.py: {error}: run it in a folder of your own")
    rospy.loginfo("wrote 3 messages on %s to %s", TOPIC, FILE)


if __name__ == "__main__":
    main()
