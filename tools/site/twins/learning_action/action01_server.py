"""An action server: adds up slowly, and reports its progress.  动作服务端：慢慢求和并反馈进度。"""

import rclpy
from learning_action_interfaces.action import AddInts
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

RATE_HZ = 10


class AddIntsServer(Node):
    def __init__(self):
        super().__init__("action_server")
        # Cancelling comes while a goal is executed, so both may be called at once.  两者可同时执行
        self.server = ActionServer(
            self, AddInts, "addInts", self.execute, callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda _goal: CancelResponse.ACCEPT)  # else it is refused  默认拒绝取消
        self.get_logger().info("ready for addInts")

    def execute(self, goal_handle):
        """Another goal does not end this one, as it did in ROS 1: each has its own handle."""
        total, num = 0, goal_handle.request.num
        rate = self.create_rate(RATE_HZ)
        for number in range(1, num + 1):
            if goal_handle.is_cancel_requested:
                self.get_logger().info(f"cancelled at {number} of {num}")
                goal_handle.canceled()
                return AddInts.Result(result=total)
            total += number
            goal_handle.publish_feedback(AddInts.Feedback(progress_bar=number / num))
            rate.sleep()
        self.get_logger().info(f"the sum is {total}")
        goal_handle.succeed()
        return AddInts.Result(result=total)


def main():
    rclpy.init()
    rclpy.spin(AddIntsServer(), MultiThreadedExecutor())


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C
