"""Follow, 1 of 3: spawn a second turtle.  跟随（一）：生成第二只海龟。"""

import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from turtlesim.srv import Spawn

X, Y, THETA = 1.0, 1.0, 3.14  # m, m, rad
NAME = "turtle2"


def main():
    rclpy.init()
    node = rclpy.create_node("generate_new")
    client = node.create_client(Spawn, "/spawn")
    while not client.wait_for_service(timeout_sec=1.0):  # until turtlesim is running  等待启动
        node.get_logger().info("waiting for /spawn")
    future = client.call_async(Spawn.Request(x=X, y=Y, theta=THETA, name=NAME))
    rclpy.spin_until_future_complete(node, future)  # it does not wait by itself  调用本身不等待
    if not future.result().name:  # turtlesim's answer to a name in use
        sys.exit(f"no turtle: is there a {NAME} already?")
    node.get_logger().info(f"spawned: {future.result().name}")


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
