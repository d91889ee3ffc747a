"""Cancel a goal that takes too long.  目标耗时太长就取消。"""

import rclpy
from action_msgs.msg import GoalStatus
from learning_action_interfaces.action import AddInts
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException

PATIENCE = 1.0  # s


def main():
    rclpy.init()
    node = rclpy.create_node("action_cancel")
    client = ActionClient(node, AddInts, "addInts")
    client.wait_for_server()
    asked = client.send_goal_async(AddInts.Goal(num=100))  # 10 s of work  需要 10 秒
    rclpy.spin_until_future_complete(node, asked)
    ended = asked.result().get_result_async()
    rclpy.spin_until_future_complete(node, ended, timeout_sec=PATIENCE)
    if not ended.done():
        node.get_logger().info(f"not done after {PATIENCE:.0f} s: cancel")
        asked.result().cancel_goal_async()
        rclpy.spin_until_future_complete(node, ended)  # until the server has stopped  等服务端停下
    cancelled = ended.result().status == GoalStatus.STATUS_CANCELED
    node.get_logger().info(
        f"{'cancelled' if cancelled else 'ended'}, result {ended.result().result.result}")


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
