"""Timer: ROS calls a function periodically.  定时器。"""

import rclpy
from rclpy.executors import ExternalShutdownException

PERIOD = 0.5  # s


def main():
    rclpy.init()
    node = rclpy.create_node("timer")
    begun = node.get_clock().now()
    count = 0

    def tick():
        """The executor calls it; it gets no event.  由执行器调用，没有 event 参数。"""
        nonlocal count
        count += 1
        late = (node.get_clock().now() - begun).nanoseconds * 1e-9 - count * PERIOD
        node.get_logger().info(f"tick, {late * 1e3:.0f} ms late")

    def once():
        node.get_logger().info("once, after 1 s")
        timer.cancel()  # there is no oneshot  没有 oneshot

    node.create_timer(PERIOD, tick)
    timer = node.create_timer(1.0, once)
    rclpy.spin(node)


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C
