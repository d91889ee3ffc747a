#!/usr/bin/env python3
"""motor_control in simulated time: its time-out and its rate follow /clock, its answers do not."""

import sys
import time
import unittest

import rospy
import rostest
from fake_controllers import FakeControllers, wait_until
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Clock

TICK = 0.01  # s


class MotorControlClock(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=100)
        cls.time = 0.0
        cls.car = FakeControllers()
        cls.commands = rospy.Publisher("motor_output", Twist, queue_size=1)
        wait_until(lambda: cls.commands.get_num_connections(), "motor_control")
        # A command from before the first time on the clock is old at once: it ends when the node
        # has read that time.
        cls.drive(1.0)
        wait_until(lambda: cls.set_clock(100.0) or cls.car.stand(), "motor_control reads the clock")

    @classmethod
    def set_clock(cls, seconds):
        cls.time = seconds
        cls.clock.publish(rospy.Time.from_sec(seconds))

    def run_clock(self, seconds):
        """Simulated time goes on in steps of TICK, at about real speed."""
        for _ in range(round(seconds / TICK)):
            self.set_clock(self.time + TICK)
            time.sleep(TICK)

    @classmethod
    def drive(cls, speed):
        message = Twist()
        message.linear.x = speed
        cls.commands.publish(message)
        cls.car.wait_for_speed(speed, f"{speed} m/s")

    def test_the_time_out_is_simulated_time(self):
        self.drive(1.0)
        self.car.told.clear()
        # On the wall more than the time-out passes, on the clock nothing does.
        wait_until(lambda: self.car.told and self.car.told[-1][0] - self.car.told[0][0] > 1.0,
                   "commands repeated while the clock stands")
        self.assertFalse(self.car.stand())
        self.run_clock(0.3)
        self.assertFalse(self.car.stand())
        self.run_clock(0.3)
        wait_until(self.car.stand, "standing after 0.6 s of simulated time")

    def test_commands_pass_while_the_clock_stands(self):
        for speed in (1.0, -2.0, 0.0, 0.5, 0.0):
            self.drive(speed)

    def test_commands_are_repeated_50_times_a_simulated_second(self):
        self.run_clock(0.1)
        self.car.told.clear()
        self.run_clock(2.0)
        wait_until(lambda: len(self.car.told) >= 6 * 90, "90 commands in 2 s for each controller")
        # A wall clock that ran on while the test was held up adds ten a second, no more.
        self.assertLess(len(self.car.told), 6 * 130)

    def test_an_old_command_does_not_come_back_with_the_clock(self):
        self.drive(1.0)
        self.set_clock(self.time - 50.0)  # the simulation was reset
        wait_until(self.car.stand, "standing after the clock was set back")
        self.car.told.clear()
        self.run_clock(0.2)
        wait_until(lambda: len(self.car.told) >= 6 * 5, "commands repeated on the new clock")
        self.assertTrue(self.car.stand())


if __name__ == "__main__":
    rospy.init_node("motor_control_clock_test")
    rostest.rosrun("car_control", "motor_control_clock", MotorControlClock, sys.argv)
