#!/usr/bin/env python3
"""What is promised of car_control.launch: start, circles, stops; all with one launch of it."""

import math
import os
import signal
import subprocess
import sys
import time
import unittest

import numpy as np
import rospy
import rostest
import yaml
from acceptance_car import (
    HINGES,
    LIMIT,
    WHEELBASE,
    WHEELS,
    ControllerStates,
    Driver,
    Truth,
    all_running,
    call,
    init_node,
    process_of,
    results_folder,
    wait_until,
    xdotool,
)
from dynamic_reconfigure.client import Client
from gazebo_msgs.srv import GetWorldProperties
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool

FULL_SPEED = 2.0  # m/s, of the page's W


class Keyboard:
    """car_control.launch's window on acceptance_user's screen, in focus, with real key events.

    `hold` and `release` are for W.
    """

    def __init__(self):
        wait_until(lambda: rospy.has_param("/acceptance_display"), "a screen")
        os.environ["DISPLAY"] = rospy.get_param("/acceptance_display")
        window = wait_until(lambda: xdotool("search", "--name", "^key_control$"), "a window")
        wait_until(lambda: "/key_control" in publishers_of("/motor_output"), "the window's topic")
        xdotool("windowfocus", "--sync", window)

    def hold(self):
        xdotool("keydown", "w")

    def release(self):
        xdotool("keyup", "w")


def publishers_of(topic):
    """Names of the nodes that publish it."""
    publishers = rospy.get_master().getSystemState()[2][0]
    return dict(publishers).get(topic, [])


STATES_PERIOD = 0.02  # s
PICTURES = 30  # a second


def stamps(messages):
    return [each.header.stamp.to_sec() for each in messages]


class Start(unittest.TestCase):
    """car_control.launch as a person meets it: topics, controllers, the picture, the W key."""

    @classmethod
    def setUpClass(cls):
        call("/gazebo/get_world_properties", GetWorldProperties)
        simulator_up = time.monotonic()
        wait_until(all_running, "seven running controllers")
        cls.running_wall, cls.running = time.monotonic() - simulator_up, rospy.get_time()
        cls.truth = Truth()

    def test_all_controllers_run_within_5_seconds(self):
        rospy.loginfo("all run at %.2f s of simulated time, %.2f s (wall) after the simulator "
                      "answered", self.running, self.running_wall)
        self.assertLess(self.running, 5.0)

    def test_rostopic_list_shows_the_controllers_topics(self):
        done = subprocess.run(["rostopic", "list"], capture_output=True, text=True, timeout=LIMIT)
        topics = set(done.stdout.split())
        wanted = {f"/racecar/{name}/command" for name in WHEELS + HINGES}
        self.assertLessEqual(wanted | {"/racecar/joint_states"}, topics)

    def test_joint_states_come_50_times_a_second(self):
        found = []
        subscriber = rospy.Subscriber("/racecar/joint_states", JointState, found.append)
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: len(found) > 100, "two seconds of joint states")
        np.testing.assert_allclose(np.diff(stamps(found)), STATES_PERIOD, atol=1e-6)
        self.assertEqual(len(found[0].name), 6)

    def test_show_shows_720p_30_times_a_second(self):
        program = subprocess.Popen(["rosrun", "car_control", "show.py"], start_new_session=True)
        self.addCleanup(program.wait)
        self.addCleanup(os.killpg, program.pid, signal.SIGINT)
        topic = wait_until(lambda: next(
            (name for name, _ in rospy.get_published_topics() if name.endswith("/windows/SHOW")),
            None), "show.py's window")
        shown = []
        window = rospy.Subscriber(topic, Image, shown.append, queue_size=100, buff_size=2**24)
        self.addCleanup(window.unregister)

        def a_full_second():
            times = stamps(shown[-PICTURES - 1:])
            return len(times) > PICTURES and times[-1] - times[0] < 1.1

        wait_until(a_full_second, f"{PICTURES} pictures in a simulated second")
        last = shown[-1]
        self.assertEqual((last.width, last.height, last.encoding), (1280, 720, "bgr8"))
        blue, _green, red = np.frombuffer(last.data, np.uint8).reshape(720, 1280, 3)[:100].T
        self.assertGreater(blue.mean(), red.mean() + 20)  # sky

    def test_w_drives_forward_and_its_release_stops(self):
        keyboard, truth = Keyboard(), self.truth
        self.addCleanup(keyboard.release)
        begin = truth.now
        keyboard.hold()
        truth.pass_time(2.0)
        self.assertAlmostEqual(truth.now.speed, FULL_SPEED, delta=0.02)
        self.assertGreater(truth.now.x - begin.x, 3.0)
        self.assertAlmostEqual(truth.now.y, begin.y, delta=0.1)
        released = rospy.get_time()
        keyboard.release()
        stop = truth.time_until_standing(released)
        rospy.loginfo("released at %.2f m/s it stands after %.2f s", FULL_SPEED, stop)
        self.assertLess(stop, 0.6)


SPEED = 1.0  # m/s
PAGE_SPEED = 2.5  # of the tutorial's law: 8 rad/s for each, 1 m/s with this car's wheels
CIRCLES = {0.34: (1.0, 1.5), -0.2: (1.0, 5.5)}  # rad: where it begins, eastwards, m
PART = math.radians(150)  # of a circle that is driven
SETTLING = 0.5  # s


def fitted_radius(samples):
    """Least squares: x^2 + y^2 = 2 a x + 2 b y + c."""
    points = np.array([(each.x, each.y) for each in samples])
    rows = np.column_stack([2 * points, np.ones(len(points))])
    a, b, c = np.linalg.lstsq(rows, (points**2).sum(axis=1), rcond=None)[0]
    return math.sqrt(c + a * a + b * b)


class Circle(unittest.TestCase):
    """Circles at constant steering: radii by Ackermann's law, and by the tutorial's to compare."""

    @classmethod
    def setUpClass(cls):
        wait_until(all_running, "seven running controllers")
        cls.truth, cls.law = Truth(), Client("/motor_control", timeout=30.0)
        cls.driver, cls.figures = Driver(), []

    @classmethod
    def tearDownClass(cls):
        cls.driver.end()
        path = results_folder(sys.argv) / "circles.yaml"
        path.write_text(yaml.safe_dump(cls.figures, sort_keys=False), encoding="utf-8")

    def driven(self, ackermann, angle):
        """Radius in parts of wheelbase / tan(angle), and mean speed in m/s."""
        truth = self.truth
        self.law.update_configuration({"ackermann": ackermann})
        truth.place(*CIRCLES[angle], 0.0)
        self.driver.drive(SPEED if ackermann else PAGE_SPEED, angle)
        truth.pass_time(SETTLING)
        first, turned = len(truth.samples), 0.0
        while turned < PART:
            before = truth.now
            wait_until(lambda before=before: truth.now.time > before.time, "the next sample")
            turned += abs(math.remainder(truth.now.yaw - before.yaw, math.tau))
        samples = truth.samples[first:]
        self.driver.drive(0.0, angle)
        truth.time_until_standing(truth.now.time)
        radius, wanted = fitted_radius(samples), WHEELBASE / math.tan(abs(angle))
        speed = float(np.mean([each.speed for each in samples]))
        self.figures.append({
            "law": "ackermann" if ackermann else "tutorial", "angle_rad": angle,
            "radius_m": round(radius, 4), "wheelbase_over_tan_m": round(wanted, 4),
            "speed_mps": round(speed, 4)})
        rospy.loginfo("circle: %s", self.figures[-1])
        return radius / wanted, speed

    def test_ackermann(self):
        for angle in CIRCLES:
            with self.subTest(angle=angle):
                ratio, speed = self.driven(True, angle)
                self.assertAlmostEqual(ratio, 1.0, delta=0.03)
                self.assertAlmostEqual(speed, SPEED, delta=0.01)

    def test_the_tutorials_law_is_recorded(self):
        self.addCleanup(self.law.update_configuration, {"ackermann": True})
        self.driven(False, max(CIRCLES))


KILLED, COMMANDS_ZERO = 0.7, 0.1  # s, simulated


class Stops(unittest.TestCase):
    """What stops the car at full speed: the emergency stop, the end of a node that drives it."""

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


class Suite(unittest.TestSuite):
    """The classes in this order, for rostest takes one name; the last one kills nodes."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(Start), load(Circle), load(Stops)])


if __name__ == "__main__":
    init_node("acceptance_car_control")
    rostest.rosrun("racecar_description", "acceptance_car_control",
                   "acceptance_car_control_contract.Suite", sys.argv)
