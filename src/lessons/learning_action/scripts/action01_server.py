#!/usr/bin/env python3
"""An action server: adds up slowly, and reports its progress.  动作服务端：慢慢求和并反馈进度。"""

import actionlib
import rospy
from learning_action.msg import AddIntsAction, AddIntsFeedback, AddIntsResult

RATE_HZ = 10


class AddInts:
    def __init__(self):
        self.server = actionlib.SimpleActionServer(
            "addInts", AddIntsAction, self.execute, auto_start=False)
        self.server.start()
        rospy.loginfo("ready for addInts")

    def execute(self, goal):
        """Runs in its own thread, for one goal at a time.  每次只执行一个目标。"""
        total = 0
        rate = rospy.Rate(RATE_HZ)
        for number in range(1, goal.num + 1):
            # Cancelled, or another goal has come.  被取消，或来了新目标
            if self.server.is_preempt_requested():
                rospy.loginfo("preempted at %d of %d", number, goal.num)
                self.server.set_preempted(AddIntsResult(total))
                return
            total += number
            self.server.publish_feedback(AddIntsFeedback(number / goal.num))
            rate.sleep()
        rospy.loginfo("the sum is %d", total)
        self.server.set_succeeded(AddIntsResult(total))


if __name__ == "__main__":
    rospy.init_node("action_server")
    AddInts()
    rospy.spin()
