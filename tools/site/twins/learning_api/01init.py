"""The options of init and create_node.  init 和 create_node 的参数。"""

import time

import rclpy
from rclpy.logging import LoggingSeverity
from rclpy.signals import SignalHandlerOptions


def main():
    # No anonymous names: ros2 run ... --ros-args -r __node:=other  没有匿名节点，用重映射改名
    # Ctrl-C raises KeyboardInterrupt, as in plain Python.  Ctrl-C 交给 Python 处理
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("init")
    node.get_logger().set_level(LoggingSeverity.DEBUG)  # also show debug messages  显示 debug 日志
    try:
        node.get_logger().debug(f"my name is {node.get_fully_qualified_name()}")
        while rclpy.ok():
            time.sleep(0.1)  # s
    except KeyboardInterrupt:
        print("Ctrl-C came as KeyboardInterrupt")


if __name__ == "__main__":
    main()
