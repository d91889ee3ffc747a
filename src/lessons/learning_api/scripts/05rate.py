#!/usr/bin/env python3
"""A loop at a fixed rate: Rate.  固定频率的循环。"""

import rospy

RATE_HZ = 5


def main():
    rospy.init_node("rate")
    rate = rospy.Rate(RATE_HZ)
    begin = rospy.Time.now()
    for _ in range(RATE_HZ):
        rospy.sleep(0.1)  # work; Rate sleeps only for the rest of the 0.2 s  只睡剩下的时间
        rate.sleep()
    rospy.loginfo("%d rounds in %.1f s", RATE_HZ, (rospy.Time.now() - begin).to_sec())


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
