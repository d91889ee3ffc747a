#!/usr/bin/env python3
"""Exercise turtle_switch: the caller starts and stops the turtle.  练习：由调用者决定走还是停。"""

import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool, SetBoolResponse

SPEED, TURN = 0.5, 0.2  # m/s, rad/s
RATE_HZ = 10


class TurtleSwitch:
    def __init__(self):
        self.driving = False
        self.publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=10)
        rospy.Service("/turtle_drive", SetBool, self.switch_callback)

    def switch_callback(self, request):
        """Runs once for each call; request.data is what the caller sent.  每次调用执行一次。"""
        self.driving = not self.driving  # yours: as requested by the caller  请修改：按调用者的要求
        return SetBoolResponse(success=True, message="drives" if self.driving else "stands")

    def publish_command(self):
        command = Twist()
        if self.driving:
            command.linear.x, command.angular.z = SPEED, TURN
        self.publisher.publish(command)


def main():
    rospy.init_node("turtle_switch")
    turtle = TurtleSwitch()
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        turtle.publish_command()
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
