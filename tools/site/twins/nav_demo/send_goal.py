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

USAGE = "ros2 run nav_demo send_goal.py X Y [DEGREES]   m on the map; e.g. send_goal.py 1.5 -1.5 90"
NAV2 = "ros2 launch nav2_bringup navigation_launch.py"
SOON, WAIT = 2.0, 30.0  # s to wait for Nav2, before and after a line  等 Nav2 应答的秒数


def place_of(words):
    """x and y, m, and degrees, from the command line.  读取命令行里的位置和角度。"""
    if {"-h", "--help"} & {*words}:
        print(USAGE)
        sys.exit(0)
    try:
        x, y, degrees = (float(word) for word in (words if len(words) == 3 else [*words, 0]))
        if not all(map(math.isfinite, (x, y, degrees))):
            raise ValueError
    except ValueError:
        place = " ".join(words)
        sys.exit(f"which place is {place!r}? e.g. ros2 run nav_demo send_goal.py 1.5 -1.5 90")
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


def wait_for_nav2(client, log):
    """Exits with one line if nobody answers, or at Ctrl-C.  没有应答或 Ctrl-C 时输出一行后退出。"""
    try:
        if client.wait_for_server(timeout_sec=SOON):
            return
        log.info(f"waiting for Nav2, for {WAIT:.0f} s: {NAV2}")
        if not client.wait_for_server(timeout_sec=WAIT):
            sys.exit(f"nobody answers as Nav2: {NAV2}")
    except KeyboardInterrupt:
        sys.exit("stopped before the goal was sent")


def result_of(node, future):
    """Waits of 0.1 s, so that Ctrl-C is seen.  每 0.1 秒检查一次 Ctrl-C"""
    while not future.done():
        rclpy.spin_until_future_complete(node, future, timeout_sec=0.1)
    return future.result()


def main():
    x, y, degrees = place_of(remove_ros_args(sys.argv)[1:])
    # Ctrl-C must leave the topics open, to cancel the goal.  Ctrl-C 后还要取消目标
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("send_goal")
    log = node.get_logger()

    def tell_progress(message):
        place = message.feedback.current_pose.pose.position
        log.info(f"the car is at {place.x:.2f}, {place.y:.2f}", throttle_duration_sec=2.0)

    client = ActionClient(node, NavigateToPose, "navigate_to_pose")
    wait_for_nav2(client, log)
    # The map is not looked at: a goal in a wall, or off the map, ends with an error of Nav2's own.
    # 不用先查地图：目标在墙里或地图外时，Nav2 自己会报错
    goal = goal_at(node, x, y, math.radians(degrees))
    handle = None
    try:
        handle = result_of(node, client.send_goal_async(goal, tell_progress))
        if not handle.accepted:
            sys.exit("Nav2 has refused the goal: is it active? ros2 lifecycle get /bt_navigator")
        result = result_of(node, handle.get_result_async())
    except KeyboardInterrupt:
        if handle:
            rclpy.spin_until_future_complete(node, handle.cancel_goal_async(), timeout_sec=2.0)
        sys.exit("stopped on the way: the goal is cancelled")
    log.info(f"status {result.status}, error {result.result.error_code}")  # 4 and 0: it is there
    sys.exit(result.status != GoalStatus.STATUS_SUCCEEDED)


if __name__ == "__main__":
    main()
