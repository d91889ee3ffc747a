import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Trigger


class TurtleCommand(Node):
    def __init__(self):
        super().__init__("turtle_command_server")
        self.driving = False
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_service(Trigger, "/turtle_command", self.command_callback)
        self.create_timer(0.1, self.publish_command)  # s

    def command_callback(self, _request, response):
        self.driving = not self.driving
        response.success, response.message = True, "Change turtle command state!"
        return response  # rospy: TriggerResponse(...)

    def publish_command(self):
        if self.driving:
            command = Twist()
            command.linear.x, command.angular.z = 0.5, 0.2
            self.publisher.publish(command)


rclpy.init()
rclpy.spin(TurtleCommand())
