"""An action client: send a goal, print the progress.  动作客户端：发送目标，查看进度和结果。"""

import rclpy
from action_msgs.msg import GoalStatus
from learning_action_interfaces.action import AddInts
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException


def main():
    rclpy.init()
    node = rclpy.create_node("action_client")
    log = node.get_logger()
    num = node.declare_parameter("num", 10).value  # another type is refused  类型不对会被拒绝
    client = ActionClient(node, AddInts, "addInts")
    log.info("waiting for addInts")
    client.wait_for_server()
    asked = client.send_goal_async(
        AddInts.Goal(num=num),
        lambda message: log.info(f"progress: {message.feedback.progress_bar * 100:.0f} %"))
    rclpy.spin_until_future_complete(node, asked)
    goal_handle = asked.result()
    if not goal_handle.accepted:
        log.error("the server has refused the goal")
        return
    log.info("the server has begun")
    ended = goal_handle.get_result_async()
    rclpy.spin_until_future_complete(node, ended)
    reached = ended.result().status == GoalStatus.STATUS_SUCCEEDED
    log.info(f"{'succeeded' if reached else 'ended'}, result {ended.result().result.result}")


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
