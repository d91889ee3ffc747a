#!/usr/bin/env python3
"""A service that starts and stops the turtle.  服务端：用服务让海龟走或停。"""

import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import Trigger, TriggerResponse

SPEED = 0.5  # m/s
TURN = 0.2  # rad/s
RATE_HZ = 10


class TurtleCommand:
    def __init__(self):
        self.driving = False
        self.publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=10)
        rospy.Service("/turtle_command", Trigger, self.command_callback)
        rospy.loginfo("ready for /turtle_command")

    def command_callback(self, _request):
        """Runs once for each call, in its own thread.  每次调用执行一次。"""
        self.driving = not self.driving
        rospy.loginfo("publish velocity: yes" if self.driving else "publish velocity: no")
        return TriggerResponse(success=True, message="Change turtle command state!")

    def publish_command(self):
        if self.driving:
            command = Twist()
            command.linear.x = SPEED
            command.angular.z = TURN
            self.publisher.publish(command)


def main():
    rospy.init_node("turtle_command_server")
    turtle = TurtleCommand()
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        turtle.publish_command()
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
