import rclpy
import tf2_geometry_msgs  # noqa: F401  lets tf2 transform a PointStamped
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from tf2_ros import Buffer, TransformException, TransformListener


class DynamicTfSub(Node):
    def __init__(self):
        super().__init__("dynamic_tf_sub")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(1.0, self.look)  # s

    def look(self):
        ahead = PointStamped()  # its stamp 0: the latest available transform
        ahead.header.frame_id = "turtle1"
        ahead.point.x = 1.0  # m
        try:
            point = self.buffer.transform(ahead, "world").point
        except TransformException as error:
            self.get_logger().warning(f"not yet: {error}", throttle_duration_sec=10.0)
        else:
            self.get_logger().info(f"in world: {point.x:.2f}, {point.y:.2f}")


rclpy.init()
rclpy.spin(DynamicTfSub())
