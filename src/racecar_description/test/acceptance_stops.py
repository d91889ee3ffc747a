"""What stops the car at full speed: the emergency stop, and the end of a node that drives it."""

import os
import signal
import unittest

import rospy
from acceptance_car import ControllerStates, Driver, Truth, all_running, process_of, wait_until
from acceptance_keyboard import FULL_SPEED, Keyboard
from std_msgs.msg import Bool

KILLED, COMMANDS_ZERO = 0.7, 0.1  # s, simulated


class Stops(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        wait_until(all_running, "seven running controllers")
        cls.truth, cls.states, cls.keyboard = Truth(), ControllerStates(), Keyboard()

    def setUp(self):
        self.truth.place(0.0, 0.0, 0.0)

    def hold_w(self):
        """Until it drives at full speed."""
        self.addCleanup(self.keyboard.release)
        self.keyboard.hold()
        self.truth.wait_for_speed(FULL_SPEED)

    def kill(self, node):
        """The simulated time at which it was killed."""
        process, now = process_of(node), rospy.get_time()
        os.kill(process, signal.SIGKILL)
        return now

    def assert_stands(self, killed, what):
        stop = self.truth.time_until_standing(killed)
        rospy.loginfo("%s killed: wheels told to stand after %.3f s, it stands after %.2f s", what,
                      self.states.time_until_zero(killed), stop)
        self.assertLess(stop, KILLED)

    def test_1_the_emergency_stop_is_obeyed_at_once_and_while_it_stands(self):
        stops = rospy.Publisher("/estop", Bool, queue_size=1, tcp_nodelay=True)
        wait_until(stops.get_num_connections, "a listener on /estop")
        self.hold_w()
        begin = rospy.get_time()
        stops.publish(True)
        zero = self.states.time_until_zero(begin)
        stand = self.truth.time_until_standing(begin)
        rospy.loginfo("emergency stop: zero after %.3f s, it stands after %.2f s", zero, stand)
        self.assertLess(zero, COMMANDS_ZERO)
        self.assertLess(stand, zero + 0.4)
        here = self.truth.now
        self.truth.pass_time(0.5)  # W is held all the time
        self.assertAlmostEqual(self.truth.now.x, here.x, delta=1e-3)
        stops.publish(False)
        self.truth.wait_for_speed(FULL_SPEED)

    def test_2_the_keyboard_is_killed(self):
        self.hold_w()
        self.assert_stands(self.kill("/key_control"), "keyboard_control")

    def test_3_motor_control_is_killed(self):
        driver = Driver()
        self.addCleanup(driver.end)
        driver.drive(FULL_SPEED, 0.0)
        self.truth.wait_for_speed(FULL_SPEED)
        self.assert_stands(self.kill("/motor_control"), "motor_control")
