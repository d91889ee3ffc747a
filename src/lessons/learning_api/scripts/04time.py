#!/usr/bin/env python3
"""Points in time and time spans: Time and Duration.  时刻与时间段。"""

import rospy


def main():
    rospy.init_node("time")
    begin = rospy.Time.now()  # needs init_node; simulated time if use_sim_time is set  需先初始化
    rospy.sleep(rospy.Duration(0.5))
    span = rospy.Time.now() - begin  # Time - Time: Duration  相减得到时间段
    rospy.loginfo("slept %.1f s", span.to_sec())
    later = rospy.Time(100, 500000000) + rospy.Duration(2)  # Time + Duration: Time  相加得到时刻
    rospy.loginfo("100.5 s + 2 s = %.1f s", later.to_sec())


if __name__ == "__main__":
    main()
