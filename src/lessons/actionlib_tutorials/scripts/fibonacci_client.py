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
    client.wait_for_server()
    client.send_goal(FibonacciGoal(order=ORDER))
    client.wait_for_result()
    print("Result:", ", ".join(str(number) for number in client.get_result().sequence))


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        print("program interrupted before completion", file=sys.stderr)
