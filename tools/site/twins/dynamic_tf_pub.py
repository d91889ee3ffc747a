import math

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose


class DynamicTfPub(Node):
    def __init__(self):
        super().__init__("dynamic_tf_pub")
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Pose, "/turtle1/pose", self.pose_callback, 1)

    def pose_callback(self, pose):
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id, transform.child_frame_id = "world", "turtle1"
        transform.transform.translation.x = pose.x
        transform.transform.translation.y = pose.y
        transform.transform.rotation.z = math.sin(pose.theta / 2)
        transform.transform.rotation.w = math.cos(pose.theta / 2)
        self.broadcaster.sendTransform(transform)


rclpy.init()
rclpy.spin(DynamicTfPub())
