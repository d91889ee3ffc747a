import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class VelocityPublisher(Node):
    def __init__(self):
        super().__init__("velocity_publisher")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_timer(0.1, self.publish)  # s; in place of rospy.Rate

    def publish(self):
        command = Twist()
        command.linear.x, command.angular.z = 0.5, 0.2
        self.publisher.publish(command)
        self.get_logger().info(f"velocity: {command.linear.x:.2f} m/s")


rclpy.init()
rclpy.spin(VelocityPublisher())
