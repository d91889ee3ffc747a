"""Sends the car to a pose on the map: send_goal.py X Y [DEGREES].  把小车派到地图上的一个位置。

move_base is Nav2 now, and its action NavigateToPose.  move_base 换成了 Nav2 的 NavigateToPose。
"""

import math
import sys

import rclpy
from action_msgs.msg import GoalStatus
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

WAIT = 30.0  # s to wait for Nav2  等 Nav2 应答的秒数


def place_of(words):
    """x and y, m, and degrees, from the command line.  读取命令行里的位置和角度。"""
    try:
        x, y, degrees = (float(word) for word in (words if len(words) == 3 else [*words, 0]))
        if not all(map(math.isfinite, (x, y, degrees))):
            raise ValueError
    except ValueError:
        place = " ".join(words)
        sys.exit(f"which place is {place!r}? e.g. ros2 run nav_demo send_goal.py 1.5 -1.5")
    return x, y, degrees


def goal_at(node, x, y, yaw):
    """A goal in the frame map; m, rad.  地图坐标系里的目标。"""
    goal = NavigateToPose.Goal()
    goal.pose.header.frame_id = "map"
    goal.pose.header.stamp = node.get_clock().now().to_msg()
    goal.pose.pose.position.x, goal.pose.pose.position.y = x, y
    # A quaternion about z uses half the angle.  绕 z 轴的四元数用半角
    goal.pose.pose.orientation.z = math.sin(yaw / 2)
    goal.pose.pose.orientation.w = math.cos(yaw / 2)
    return goal


def main():
    x, y, degrees = place_of(remove_ros_args(sys.argv)[1:])
    # Ctrl-C must leave the topics open, to cancel the goal.  Ctrl-C 后还要取消目标
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("send_goal")
    log = node.get_logger()

    def tell_progress(message):
        place = message.feedback.current_pose.pose.position
        log.info(f"at {place.x:.2f}, {place.y:.2f}", throttle_duration_sec=2.0)

    client = ActionClient(node, NavigateToPose, "navigate_to_pose")
    if not client.wait_for_server(timeout_sec=WAIT):
        sys.exit("nobody answers: type ros2 launch nav2_bringup navigation_launch.py")
    asked = client.send_goal_async(goal_at(node, x, y, math.radians(degrees)), tell_progress)
    rclpy.spin_until_future_complete(node, asked)
    if not asked.result().accepted:
        sys.exit("Nav2 has refused the goal: is it active? ros2 lifecycle nodes")
    ended = asked.result().get_result_async()
    try:
        while not ended.done():  # waits of 0.1 s, so that Ctrl-C is seen  每 0.1 秒检查一次 Ctrl-C
            rclpy.spin_until_future_complete(node, ended, timeout_sec=0.1)
    except KeyboardInterrupt:
        rclpy.spin_until_future_complete(node, asked.result().cancel_goal_async(), timeout_sec=2.0)
        sys.exit("stopped on the way: the goal is cancelled")
    result = ended.result()
    log.info(f"status {result.status}, error {result.result.error_code}")  # 4 and 0: it is there
    sys.exit(result.status != GoalStatus.STATUS_SUCCEEDED)


if __name__ == "__main__":
    main()
