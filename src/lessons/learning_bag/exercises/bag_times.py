#!/usr/bin/env python3
"""Exercise bag_times: ten messages, half a second apart.  练习：十条消息，相隔半秒。"""

import rosbag
import rospy
from std_msgs.msg import String

FILE = "test.bag"  # in the current folder; overwritten if it exists  写在当前目录，会覆盖
TOPIC = "chatter"
COUNT, PERIOD = 10, 0.5  # messages; s
BEGIN = 1.0  # s; a bag does not accept time 0  时间不能为 0


def main():
    with rosbag.Bag(FILE, "w") as bag:
        for count in range(COUNT):
            time = rospy.Time.from_sec(BEGIN)  # yours: later for each message  请修改：每条递增
            bag.write(TOPIC, String(data=f"hello {count}"), t=time)


if __name__ == "__main__":
    main()
