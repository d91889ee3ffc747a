#!/usr/bin/env python3
"""Drives straight for a while, turns for a while, stops: commands at 10 Hz, no camera.

直行一段时间，再转一段时间，然后停下：10 Hz 发送速度，不用摄像头。
"""

import sys
import time
from dataclasses import dataclass

import rospy
from ai_robot_tracking.parameters import read_settings
from geometry_msgs.msg import Twist
from node_basics.settings import number

RATE_HZ = 10
PATIENCE = 1.0  # s, wall, in which a running robot connects


@dataclass(frozen=True)
class ControllerSettings:
    """Section simple_controller of the parameter file."""

    speed: float = number(-1, 1, "m/s")
    duration: float = number(0, 3600, "s")
    turn: float = number(-3, 3, "rad/s, left positive")
    turn_duration: float = number(0, 3600, "s")


class SimpleController:
    def __init__(self):
        self.publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.on_shutdown(self.stop)

    def forward(self, speed, duration):
        """Drive at this speed (m/s) for this time (s)."""
        self.send(speed, 0.0, duration)

    def rotate(self, turn, duration):
        """Turn at this rate (rad/s) for this time (s)."""
        self.send(0.0, turn, duration)

    def send(self, speed, turn, duration):
        message, rate = Twist(), rospy.Rate(RATE_HZ, reset=True)
        message.linear.x, message.angular.z = speed, turn
        begun = rospy.get_time()
        while 0 <= rospy.get_time() - begun < duration and not rospy.is_shutdown():
            self.publisher.publish(message)  # repeatedly: the robot's commands expire
            try:
                rate.sleep()
            except rospy.ROSInterruptException:
                return

    def stop(self):
        self.publisher.publish(Twist())
        time.sleep(0.2)  # s, wall: sending takes time


def main():
    rospy.init_node("simple_controller")
    settings = read_settings(ControllerSettings, "simple_controller")
    controller = SimpleController()
    patient_until = time.monotonic() + PATIENCE
    while controller.publisher.get_num_connections() == 0 and not rospy.is_shutdown():
        if time.monotonic() > patient_until:
            rospy.logwarn_throttle(5, "nothing subscribes to %s yet",
                                   controller.publisher.resolved_name)
        time.sleep(0.05)
    controller.forward(settings.speed, settings.duration)
    controller.rotate(settings.turn, settings.turn_duration)
    rospy.loginfo("the drive is over, the robot stands")
    return 0


if __name__ == "__main__":
    sys.exit(main())
