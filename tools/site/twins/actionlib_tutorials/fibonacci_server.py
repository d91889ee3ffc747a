"""An action server: a number of the Fibonacci sequence each second.  动作服务端：每秒算一个数。"""

import rclpy
from actionlib_tutorials_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class FibonacciServer(Node):
    def __init__(self):
        super().__init__("fibonacci")
        self.server = ActionServer(
            self, Fibonacci, "fibonacci", self.execute, callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda _goal: CancelResponse.ACCEPT)

    def execute(self, goal_handle):
        sequence, order = [0, 1], goal_handle.request.order
        self.get_logger().info(f"Executing, creating fibonacci sequence of order {order} "
                               "with seeds 0, 1")
        rate = self.create_rate(1)
        for _ in range(1, order):
            if goal_handle.is_cancel_requested:
                self.get_logger().info("Cancelled")
                goal_handle.canceled()
                return Fibonacci.Result(sequence=sequence)
            sequence.append(sequence[-1] + sequence[-2])
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            rate.sleep()
        self.get_logger().info("Succeeded")
        goal_handle.succeed()
        return Fibonacci.Result(sequence=sequence)


def main():
    rclpy.init()
    rclpy.spin(FibonacciServer(), MultiThreadedExecutor())  # cancelling comes while it executes


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C
