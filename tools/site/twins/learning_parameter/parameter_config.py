"""Make turtlesim's background white: read and set parameters.  读写参数，改背景色。"""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient

WHITE = 255
NAMES = ["background_r", "background_g", "background_b"]


def main():
    rclpy.init()
    node = rclpy.create_node("parameter_config")
    turtlesim = AsyncParameterClient(node, "turtlesim")  # by that node's services
    turtlesim.wait_for_services()

    def show_background():
        future = turtlesim.get_parameters(NAMES)
        rclpy.spin_until_future_complete(node, future)
        red, green, blue = (each.integer_value for each in future.result().values)
        node.get_logger().info(f"background: r {red}, g {green}, b {blue}")

    show_background()
    future = turtlesim.set_parameters([Parameter(name, value=WHITE) for name in NAMES])
    rclpy.spin_until_future_complete(node, future)
    show_background()  # turtlesim hears of it and changes at once: no /clear  不用再调用 /clear


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
