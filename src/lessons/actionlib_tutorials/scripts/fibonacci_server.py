#!/usr/bin/env python3
"""An action server: a number of the Fibonacci sequence each second.  动作服务端：每秒算一个数。"""

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciFeedback, FibonacciResult


class Fibonacci:
    def __init__(self, name):
        self.name = name
        self.server = actionlib.SimpleActionServer(
            name, FibonacciAction, self.execute, auto_start=False)
        self.server.start()

    def execute(self, goal):
        """Runs in its own thread, for one goal at a time.  每次只执行一个目标。"""
        sequence = [0, 1]
        rospy.loginfo("%s: Executing, creating fibonacci sequence of order %i with seeds %i, %i",
                      self.name, goal.order, *sequence)
        rate = rospy.Rate(1)
        for _ in range(1, goal.order):
            # Cancelled, or another goal has come.  被取消，或来了新目标
            if self.server.is_preempt_requested():
                rospy.loginfo("%s: Preempted", self.name)
                self.server.set_preempted()
                return
            sequence.append(sequence[-1] + sequence[-2])
            self.server.publish_feedback(FibonacciFeedback(sequence))
            rate.sleep()
        rospy.loginfo("%s: Succeeded", self.name)
        self.server.set_succeeded(FibonacciResult(sequence))


if __name__ == "__main__":
    rospy.init_node("fibonacci")
    Fibonacci(rospy.get_name())
    rospy.spin()
