#!/usr/bin/env python3
"""Timer: ROS calls a function periodically.  定时器。"""

import rospy


def tick(event):
    """Runs in its own thread.  在单独的线程中执行。"""
    late = event.current_real - event.current_expected
    rospy.loginfo("tick, %.0f ms late", late.to_sec() * 1e3)


def once(_event):
    rospy.loginfo("once, after 1 s")


def main():
    rospy.init_node("timer")
    rospy.Timer(rospy.Duration(0.5), tick)
    rospy.Timer(rospy.Duration(1.0), once, oneshot=True)
    rospy.spin()


if __name__ == "__main__":
    main()
