#!/usr/bin/env python3
"""Clean shutdown: is_shutdown, signal_shutdown, on_shutdown.  节点的正常退出。"""

import rospy


def say_goodbye():
    rospy.loginfo("last words: stop the motors here")


def main():
    rospy.init_node("shutdown")
    rospy.on_shutdown(say_goodbye)  # called at shutdown, also after Ctrl-C  退出时调用
    count = 0
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        count += 1
        rospy.loginfo("round %d", count)
        if count == 5:
            rospy.signal_shutdown("five rounds are enough")  # now is_shutdown() is true
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # shut down while sleeping  睡眠时退出
