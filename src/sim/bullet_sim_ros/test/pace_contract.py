#!/usr/bin/env python3
"""Simulated time against the wall clock: as the options and services say, whoever hangs on it."""

import math
import os
import re
import signal
import socket
import statistics
import struct
import subprocess
import sys
import time
import unittest
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from gazebo_msgs.msg import PerformanceMetrics
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from gzserver_process import LIMIT, NODE, Gzserver, wait_until
from rosgraph.network import encode_ros_handshake_header
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image, LaserScan
from std_srvs.srv import Empty

IMAGES = "/eye/image_raw"
WINDOW = 1.0  # s, wall, over which the pace is taken
TRIES = 20  # windows; other programs may take the processor in one of them
GUESTS, VISITS = 20, 10
HANGING = f"""
import rospy
from sensor_msgs.msg import Image, LaserScan
rospy.init_node("hanging", disable_rostime=True)
seen = set()
for topic, kind in (("{IMAGES}", Image), ("/scan", LaserScan)):
    rospy.Subscriber(topic, kind, lambda msg, topic=topic: seen.add(topic))
while len(seen) < 2:
    rospy.rostime.wallsleep(0.01)
print("connected", flush=True)
rospy.spin()
"""


class Pace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Gzserver("--real_time_factor", "0.5").wait_until_ready()
        cls.now = 0.0
        cls.clock = rospy.Subscriber("/clock", Clock, cls.on_clock)
        cls.at_start = cls.physics()

    @classmethod
    def tearDownClass(cls):
        code, _ = cls.server.end()
        assert code == 0, cls.server.output()

    @classmethod
    def on_clock(cls, msg):
        cls.now = msg.clock.to_sec()

    @classmethod
    def physics(cls):
        return cls.server.call("get_physics_properties", GetPhysicsProperties)

    def setUp(self):
        self.set_physics(self.at_start)
        self.server.call("unpause_physics", Empty)

    def set_physics(self, state, **changes):
        """As somebody does it who wants a few fields changed."""
        fields = {"time_step": state.time_step, "max_update_rate": state.max_update_rate,
                  "gravity": state.gravity, "ode_config": state.ode_config} | changes
        return self.server.call("set_physics_properties", SetPhysicsProperties, **fields)

    def subscribe(self, topic, kind):
        """The list that its messages come into."""
        found = []
        subscriber = rospy.Subscriber(topic, kind, found.append, queue_size=None)
        self.addCleanup(subscriber.unregister)
        return found

    def wait_for_time(self, seconds):
        until = self.now + seconds
        wait_until(lambda: self.now >= until, f"{seconds} simulated seconds")

    # --- pace

    def factor(self):
        """Simulated seconds per wall second, of one window."""
        before = self.now
        wait_until(lambda: self.now != before, "/clock")
        simulated, wall = self.now, time.monotonic()
        time.sleep(WINDOW)
        return (self.now - simulated) / (time.monotonic() - wall)

    def assert_pace(self, least, most):
        found = []
        while len(found) < TRIES:
            found.append(self.factor())
            if least <= found[-1] <= most:
                return
        self.fail(f"simulated time ran at {found} of real time, not {least} to {most}")

    def test_pace_follows_option_step_and_update_rate(self):
        self.assertEqual(self.at_start.max_update_rate, 500.0)  # of --real_time_factor 0.5
        self.assert_pace(0.4, 0.55)
        self.set_physics(self.at_start, max_update_rate=250.0)
        self.assert_pace(0.2, 0.28)
        self.set_physics(self.at_start, time_step=0.002)
        self.assert_pace(0.8, 1.1)
        self.set_physics(self.at_start, max_update_rate=2000.0)
        self.assert_pace(1.5, 2.2)
        self.set_physics(self.at_start, max_update_rate=0.0)
        self.assert_pace(2.5, float("inf"))

    def test_sensors_keep_their_rates_in_simulated_time_with_another_step(self):
        self.set_physics(self.at_start, time_step=0.002, max_update_rate=0.0)
        images, scans = self.subscribe(IMAGES, Image), self.subscribe("/scan", LaserScan)
        wait_until(lambda: len(images) > 25 and len(scans) > 12, "images and scans")
        for messages, period in ((images[1:], 0.05), (scans[1:], 0.1)):  # one may be of before
            stamps = [message.header.stamp.to_sec() for message in messages]
            gaps = [now - before for before, now in pairwise(stamps)]
            self.assertAlmostEqual(statistics.median(gaps), period, places=6)
            for gap in gaps:  # who is slower than the simulation misses some
                self.assertAlmostEqual(math.remainder(gap, period), 0.0, places=6)

    # --- physics properties

    def test_what_was_set_is_what_one_gets(self):
        wanted = self.physics()
        wanted.gravity.x, wanted.gravity.z = 0.5, -3.0
        wanted.ode_config.sor_pgs_iters, wanted.ode_config.max_contacts = 77, 13
        wanted.ode_config.cfm, wanted.ode_config.erp = 0.25, 0.5
        answer = self.set_physics(wanted, time_step=0.004, max_update_rate=125.0)
        self.assertTrue(answer.success, answer.status_message)
        found = self.physics()
        self.assertEqual((found.time_step, found.max_update_rate), (0.004, 125.0))
        self.assertEqual((found.gravity, found.ode_config), (wanted.gravity, wanted.ode_config))

    def test_what_makes_no_sense_is_refused_in_one_line_and_nothing_changes(self):
        before = self.physics()
        for field, values in {
                "time_step": (0.0, -0.001, 1e-9, 10.0, float("nan"), float("inf")),
                "max_update_rate": (-1.0, float("nan"), float("inf"))}.items():
            for value in values:
                self.assert_refused(before, f"{value:g}", **{field: value})
        for value in (float("nan"), float("inf"), 1e9):
            state = self.physics()
            state.gravity.z = value
            self.assert_refused(before, "gravity", gravity=state.gravity)
        state = self.physics()
        state.ode_config.sor_pgs_iters = 2 ** 32 - 1
        self.assert_refused(before, "4294967295 solver iterations", ode_config=state.ode_config)
        self.wait_for_time(0.1)

    def assert_refused(self, before, said, **changes):
        answer = self.set_physics(before, **changes)
        self.assertFalse(answer.success, changes)
        self.assertRegex(answer.status_message, "^SetPhysicsProperties: .*" + re.escape(said))
        self.assertNotIn("\n", answer.status_message)
        self.assertEqual(self.physics(), before)

    # --- what is told

    def test_performance_metrics(self):
        self.set_physics(self.at_start, max_update_rate=2000.0)
        self.subscribe(IMAGES, Image)
        self.subscribe("/scan", LaserScan)
        told = self.subscribe(f"{NODE}/performance_metrics", PerformanceMetrics)
        # Half a second more than the window over which rates are taken, after all have connected.
        wait_until(lambda: told and {s.name: s for s in told[-1].sensors}["lidar"].sim_update_rate,
                   "rates")
        for left in reversed(range(TRIES)):
            wait_until(lambda first=len(told): len(told) > first + 6, "a window of rates")
            try:
                return self.check_metrics(told[-1])
            except AssertionError:
                if not left:
                    raise

    def check_metrics(self, msg):
        sensors = {sensor.name: sensor for sensor in msg.sensors}
        self.assertEqual(set(sensors), {"eye", "lidar"})
        for name, rate_hz in (("eye", 20.0), ("lidar", 10.0)):
            self.assertAlmostEqual(sensors[name].sim_update_rate, rate_hz, delta=0.15 * rate_hz)
            self.assertAlmostEqual(sensors[name].real_update_rate / sensors[name].sim_update_rate,
                                   msg.real_time_factor, delta=0.5 * msg.real_time_factor)
        self.assertEqual(sensors["lidar"].fps, -1.0)
        self.assertEqual(sensors["eye"].fps, sensors["eye"].real_update_rate)
        self.assertTrue(0.5 < msg.real_time_factor < 2.3, msg.real_time_factor)
        self.assertAlmostEqual(msg.header.stamp.to_sec(), self.now, delta=2.0)

    def test_the_camera_and_its_renderer_are_told_at_the_start(self):
        line = rf"Cameras are drawn by \w+.*\n.*camera {IMAGES} \(64x48\): \d+\.\d ms a frame"
        wait_until(lambda: re.search(line, self.server.output(), re.DOTALL), "what frames cost")

    # --- whoever hangs on it

    def test_a_subscriber_that_hangs_holds_up_nobody(self):
        self.set_physics(self.at_start, max_update_rate=0.0)
        images = self.subscribe(IMAGES, Image)
        wait_until(lambda: images, "an image")
        before = self.held()
        hanging = subprocess.Popen([sys.executable, "-c", HANGING], stdout=subprocess.PIPE)
        self.addCleanup(hanging.stdout.close)
        self.addCleanup(hanging.wait)
        self.addCleanup(hanging.kill)
        self.assertEqual(hanging.stdout.readline(), b"connected\n")
        hanging.send_signal(signal.SIGSTOP)
        self.wait_for_time(60.0)  # 11 MB of images: more than a connection takes in
        first = len(images)
        wait_until(lambda: len(images) > first + 20, "images for others")
        hanging.kill()
        self.wait_until_held(before)

    def test_subscribers_that_come_and_go(self):
        self.set_physics(self.at_start, max_update_rate=0.0)
        uri = rosgraph.Master("/pace_contract").lookupNode(NODE)
        images = self.subscribe(IMAGES, Image)
        wait_until(lambda: images, "an image")
        before = self.held()
        with ThreadPoolExecutor(GUESTS) as pool:
            visits = pool.map(lambda number: come_and_go(uri, number), range(GUESTS))
            self.assertEqual(sum(visits), GUESTS * VISITS)
        self.wait_for_time(2.0)
        first = len(images)
        wait_until(lambda: len(images) > first + 20, "images for those who stay")
        self.wait_until_held(before)

    def held(self):
        """How many threads and open files the simulator has."""
        return sum(len(os.listdir(f"/proc/{self.server.process.pid}/{what}"))
                   for what in ("task", "fd"))

    def wait_until_held(self, before):
        """What guests took is given back, but for a connection that may be in the making."""
        wait_until(lambda: self.held() <= before + 1, f"{before} threads and files again")


def come_and_go(uri, number):
    """Connect to a topic, read a little or nothing, and leave without a word, again and again."""
    topic, kind = (("/clock", Clock), (IMAGES, Image))[number % 2]
    me = f"/guest_{number}"
    header = encode_ros_handshake_header({
        "topic": topic, "callerid": me, "type": kind._type, "md5sum": kind._md5sum})
    for visit in range(VISITS):
        with ServerProxy(uri) as node:
            _, host, port = node.requestTopic(me, topic, [["TCPROS"]])[2]
        with socket.create_connection((host, port), LIMIT) as connection:
            connection.sendall(header)
            if visit % 3:
                connection.recv(1000)
            if visit % 2:  # with a reset instead of a farewell
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    return VISITS


if __name__ == "__main__":
    rospy.init_node("pace_contract", disable_rostime=True)
    rostest.rosrun("bullet_sim_ros", "pace", Pace)
