#!/usr/bin/env python3
"""The five log levels.  五个日志级别。"""

import rospy


def main():
    rospy.init_node("log")  # shows INFO and above; log_level=rospy.DEBUG: all  默认不显示 debug
    rospy.logdebug("debug: for whoever mends the program")
    rospy.loginfo("info: what is going on")
    rospy.logwarn("warn: goes on, but not as it should")
    rospy.logerr("error: something failed")
    rospy.logfatal("fatal: the program cannot go on")
    for count in range(10):
        rospy.loginfo_throttle(0.5, "once in 0.5 s: %d", count)
        rospy.loginfo_once("once only: %d", count)
        rospy.sleep(0.1)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
