"""car_control.launch as a person meets it: topics, controllers, the picture, the W key."""

import os
import signal
import subprocess
import time
import unittest

import numpy as np
import rospy
from acceptance_car import HINGES, LIMIT, WHEELS, Truth, all_running, call, wait_until
from acceptance_keyboard import FULL_SPEED, Keyboard
from gazebo_msgs.srv import GetWorldProperties
from sensor_msgs.msg import Image, JointState

STATES_PERIOD = 0.02  # s
PICTURES = 30  # a second


def stamps(messages):
    return [each.header.stamp.to_sec() for each in messages]


class Start(unittest.TestCase):
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
