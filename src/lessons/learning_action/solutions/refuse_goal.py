#!/usr/bin/env python3
"""Exercise refuse_goal: abort goals below 1.  练习：拒绝小于 1 的目标。"""

import actionlib
import rospy
from learning_action.msg import AddIntsAction, AddIntsFeedback, AddIntsResult

RATE_HZ = 10


class AddInts:
    def __init__(self):
        self.server = actionlib.SimpleActionServer(
            "addInts", AddIntsAction, self.execute, auto_start=False)
        self.server.start()

    def execute(self, goal):
        """Runs in its own thread, for one goal at a time.  每次只执行一个目标。"""
        if goal.num < 1:
            self.server.set_aborted(AddIntsResult(), "num must be 1 or more")
            return
        total = 0
        rate = rospy.Rate(RATE_HZ)
        for number in range(1, goal.num + 1):
            if self.server.is_preempt_requested():
                self.server.set_preempted(AddIntsResult(total))
                return
            total += number
            self.server.publish_feedback(AddIntsFeedback(number / goal.num))
            rate.sleep()
        self.server.set_succeeded(AddIntsResult(total))


if __name__ == "__main__":
    rospy.init_node("action_server")
    AddInts()
    rospy.spin()
