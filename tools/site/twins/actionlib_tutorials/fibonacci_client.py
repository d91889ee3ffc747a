"""An action client: asks for 20 Fibonacci numbers.  动作客户端：要二十个斐波那契数。"""

import sys

import rclpy
from actionlib_tutorials_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException

ORDER = 20


def main():
    rclpy.init()
    node = rclpy.create_node("fibonacci_client_py")
    client = ActionClient(node, Fibonacci, "fibonacci")
    client.wait_for_server()
    asked = client.send_goal_async(Fibonacci.Goal(order=ORDER))
    rclpy.spin_until_future_complete(node, asked)
    ended = asked.result().get_result_async()
    rclpy.spin_until_future_complete(node, ended)
    print("Result:", ", ".join(str(number) for number in ended.result().result.sequence))


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        print("program interrupted before completion", file=sys.stderr)
