"""Clean shutdown: ok, shutdown, on_shutdown.  节点的正常退出。"""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.logging import get_logger


def say_goodbye():
    # Topics are closed by now: who stops a robot does it before.  此时话题已关闭，停车要更早
    get_logger("shutdown").info("last words")


def main():
    rclpy.init()
    node = rclpy.create_node("shutdown")
    rclpy.get_default_context().on_shutdown(say_goodbye)  # also after Ctrl-C  Ctrl-C 也会调用
    count = 0

    def tick():
        nonlocal count
        count += 1
        node.get_logger().info(f"round {count}")
        if count == 5:
            node.get_logger().info("five rounds are enough")
            rclpy.shutdown()  # now ok() is false, and spin() ends

    node.create_timer(0.1, tick)  # s
    rclpy.spin(node)


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C
