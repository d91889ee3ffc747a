"""Clean shutdown: ok, shutdown, on_shutdown.  节点的正常退出。"""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.signals import SignalHandlerOptions


def say_goodbye():
    # The topics are closed by now, and the log is one: a robot is stopped before.
    # 此时话题（包括日志）已关闭，停车要更早
    print("last words")


def main():
    # ROS's own handler of Ctrl-C ends the context, but does not call say_goodbye.
    # ROS 自己处理 Ctrl-C 时不会调用 say_goodbye
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("shutdown")
    rclpy.get_default_context().on_shutdown(say_goodbye)  # called by shutdown()
    count = 0

    def tick():
        nonlocal count
        count += 1
        node.get_logger().info(f"round {count}")
        if count == 5:
            node.get_logger().info("five rounds are enough")
            rclpy.shutdown()  # now ok() is false, and spin() ends

    node.create_timer(0.1, tick)  # s
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C, or shutdown()
    finally:
        rclpy.try_shutdown()  # unless it is shut down already  已关闭则什么也不做


if __name__ == "__main__":
    main()
