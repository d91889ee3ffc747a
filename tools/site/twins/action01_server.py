import time

import rclpy
from learning_action_interfaces.action import AddInts
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class AddIntsServer(Node):
    def __init__(self):
        super().__init__("action_server")
        self.server = ActionServer(
            self, AddInts, "addInts", self.execute, callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda _goal: CancelResponse.ACCEPT)

    def execute(self, goal_handle):
        total, num = 0, goal_handle.request.num
        for number in range(1, num + 1):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return AddInts.Result(result=total)
            total += number
            goal_handle.publish_feedback(AddInts.Feedback(progress_bar=number / num))
            time.sleep(0.1)  # s
        goal_handle.succeed()
        return AddInts.Result(result=total)


rclpy.init()
rclpy.spin(AddIntsServer(), MultiThreadedExecutor())  # cancelling comes while it executes
