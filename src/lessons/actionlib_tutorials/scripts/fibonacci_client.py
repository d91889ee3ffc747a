#!/usr/bin/env python3
"""An action client: asks for 20 Fibonacci numbers.  动作客户端：要二十个斐波那契数。"""

import sys

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal

ORDER = 20


def main():
    rospy.init_node("fibonacci_client_py")
    client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
    if not client.wait_for_server():  # Ctrl-C while waiting  等待时按下 Ctrl-C
        raise rospy.ROSInterruptException
    client.send_goal(FibonacciGoal(order=ORDER))
    if not client.wait_for_result():
        raise rospy.ROSInterruptException
    print("Result:", ", ".join(str(number) for number in client.get_result().sequence))


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        print("program interrupted before completion", file=sys.stderr)
