#!/usr/bin/env python3
"""In lockstep a follower of any speed sees every frame once, and one seed is one run."""

import hashlib
import io
import re
import time
import unittest
import xml.etree.ElementTree as ET

import numpy as np
import rospy
import rostest
from gazebo_msgs.srv import DeleteModel, GetModelState, GetWorldProperties, SpawnModel
from geometry_msgs.msg import Twist
from gzserver_process import LIMIT, WORLD, Gzserver, wait_until
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, Imu, JointState, LaserScan
from std_msgs.msg import Empty as EmptyMsg
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

IMAGES = "/eye/image_raw"
FRAME_PERIOD = 50_000_000  # ns
FRAMES = 60
# What comes in that time.
RECORDED = {(IMAGES, Image): FRAMES, ("/scan", LaserScan): FRAMES // 2,
            ("/odom", Odometry): FRAMES, ("/joint_states", JointState): FRAMES,
            ("/imu", Imu): FRAMES * 5 // 2, ("/tf", TFMessage): FRAMES}
COUNTS = {topic: count for (topic, _), count in RECORDED.items()}
# Of the profile, and how often each is done for eight frames; some pictures are drawn on trial.
STAGES = {"physics": 400, "scene": 9, "send": 8}
STAGES_OF_TRIAL = ("draw", "convert", "noise")
DELAY = 0.1  # s, wall, of a slow follower's answer
END_LIMIT = 3.0  # s, wall; what a person waits after Ctrl-C


def nanoseconds(stamp):
    return stamp.secs * 1_000_000_000 + stamp.nsecs


def steer(image):
    """A command that depends on every pixel, noise included."""
    pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
    left, right = np.hsplit(pixels.astype(np.int64), 2)
    command = Twist()
    command.linear.x = 0.2
    command.angular.z = float(left.sum() - right.sum()) / pixels.sum() * 3.0
    return command


class Follower:
    """Takes images and answers each, if `delay` (s) of its number is not None.

    With the image number `last` it pauses the world before it answers.
    """

    def __init__(self, answer, kind=Twist, delay=lambda number: 0.0, last=None):
        self.images, self.answered = [], 0
        self._make = steer if kind is Twist else lambda image: kind()
        self._delay, self._last = delay, last
        self._answers = rospy.Publisher(answer, kind, queue_size=1, tcp_nodelay=True)
        self._images = rospy.Subscriber(IMAGES, Image, self._take, queue_size=None,
                                        tcp_nodelay=True)

    def wait_until_connected(self):
        wait_until(self._answers.get_num_connections, f"a subscriber of {self._answers.name}")
        wait_until(self._images.get_num_connections, "the camera")

    def _take(self, image):
        self.images.append(image)
        delay = self._delay(len(self.images))
        if len(self.images) == self._last:
            rospy.ServiceProxy("/gazebo/pause_physics", Empty)()
        if delay is not None:
            time.sleep(delay)
            self._answers.publish(self._make(image))
            self.answered += 1

    def stamps(self):
        return [nanoseconds(image.header.stamp) for image in self.images]

    def close(self):
        self._images.unregister()
        self._answers.unregister()


class Recorder:
    """Every byte of every message, by topic."""

    def __init__(self):
        self._messages = {topic: [] for topic in COUNTS}
        self._subscribers = [
            rospy.Subscriber(topic, kind, self._messages[topic].append, queue_size=None)
            for topic, kind in RECORDED]
        for subscriber in self._subscribers:
            wait_until(subscriber.get_num_connections, subscriber.name)

    def counts(self):
        return {topic: len(kept) for topic, kept in self._messages.items()}

    def hashes(self):
        return {topic: self._hash(kept) for topic, kept in self._messages.items()}

    @staticmethod
    def _hash(messages):
        buffer = io.BytesIO()
        for message in messages:
            message.serialize(buffer)
        return hashlib.sha256(buffer.getvalue()).hexdigest()

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


class Lockstep(unittest.TestCase):
    def start(self, *options, **parameters):
        server = Gzserver(*options, **parameters)
        self.addCleanup(server.end)
        return server.wait_until_ready()

    def follow(self, *arguments, **options):
        follower = Follower(*arguments, **options)
        self.addCleanup(follower.close)
        follower.wait_until_connected()
        return follower

    # --- one seed, one run

    def record(self, seed, factor, delay):
        """What is received over FRAMES frames by a process of its own."""
        server = self.start("--seed", str(seed), "--real_time_factor", factor,
                            lockstep="/cmd_vel", lockstep_timeout=LIMIT)
        follower = self.follow("/cmd_vel", delay=delay, last=FRAMES)
        recorder = Recorder()
        self.addCleanup(recorder.close)
        server.call("unpause_physics", Empty)
        wait_until(lambda: recorder.counts() == COUNTS, COUNTS)
        end = server.call("get_model_state", GetModelState, "robot", "")
        recorder.close()
        follower.close()
        server.end()
        self.assertEqual(recorder.counts(), COUNTS)
        self.assertNotIn("no message on", server.output())
        self.assertGreater(end.pose.position.x, 0.2)
        return recorder

    def test_one_seed_is_one_run_and_another_one_is_not(self):
        first = self.record(5, "0", lambda number: 0.0).hashes()
        slow = self.record(5, "3", lambda number: 0.03 * (number % 4 == 0)).hashes()
        self.assertEqual(first, slow)
        other = self.record(6, "0", lambda number: 0.0).hashes()
        for topic in (IMAGES, "/scan", "/imu"):
            self.assertNotEqual(first[topic], other[topic], topic)

    # --- frames and answers

    def test_a_slow_follower_sees_every_frame_once(self):
        server = self.start(lockstep="/cmd_vel", lockstep_timeout=LIMIT, profile=True)
        slow = self.follow("/cmd_vel", delay=lambda number: self.delay_of_waiting(server), last=8)
        server.call("unpause_physics", Empty)
        wait_until(lambda: slow.answered == 8, "eight frames and answers")
        self.assertEqual(slow.stamps(), [FRAME_PERIOD * number for number in range(1, 9)])
        self.assertEqual(self.stand_still(server), 0.4)
        server.end()
        self.check_stages(server.output())

    def delay_of_waiting(self, server):
        """It begins when the loop waits: while a frame is unanswered it takes calls only there."""
        server.call("get_world_properties", GetWorldProperties)
        return DELAY

    def check_stages(self, output):
        """The table at the end of eight frames."""
        self.assertRegex(
            output, r"stages of the work in \d+ s\nstage +times +ms each +worst ms +share\n")
        row = re.compile(r"^([a-z ]+?) +(\d+) +([\d.]+) +[\d.]+ +[\d.]+%$", re.MULTILINE)
        rows = {name: (int(times), float(each)) for name, times, each in row.findall(output)}
        for name, times in STAGES.items():
            self.assertEqual(rows[name][0], times, output)
        for name in STAGES_OF_TRIAL:
            self.assertGreater(rows[name][0], 8, output)
        self.assertGreater(rows["lockstep"][0] * rows["lockstep"][1], 8 * DELAY * 1e3)

    def stand_still(self, server):
        """Time does not go on, and calls are answered."""
        first = server.call("get_world_properties", GetWorldProperties).sim_time
        for _ in range(20):
            now = server.call("get_world_properties", GetWorldProperties).sim_time
            self.assertEqual(now, first)
        return first

    def test_while_it_waits_calls_are_answered_and_it_can_be_ended(self):
        """Paused, reset, robbed of the robot that it waits for, and interrupted."""
        server = self.start("--real_time_factor", "0", lockstep="/cmd_vel",
                            lockstep_timeout=10 * LIMIT)
        follower = self.follow("/cmd_vel", delay=lambda number: None)
        server.call("unpause_physics", Empty)
        wait_until(lambda: len(follower.images) == 1, "a frame")
        self.assertEqual(self.stand_still(server), 0.05)
        server.call("pause_physics", Empty)
        server.call("unpause_physics", Empty)
        self.assertEqual(self.stand_still(server), 0.05)
        server.call("reset_simulation", Empty)
        wait_until(lambda: server.call("get_world_properties", GetWorldProperties).sim_time == 0.05,
                   "a frame after the reset")
        self.stand_still(server)
        server.call("delete_model", DeleteModel, "robot")
        wait_until(lambda: server.call("get_world_properties", GetWorldProperties).sim_time > 1.0,
                   "time that goes on without the robot")
        robot = ET.tostring(ET.parse(WORLD).find("world/model[@name='robot']"), "unicode")
        server.call("spawn_sdf_model", SpawnModel, model_name="robot",
                    model_xml=f"<sdf version='1.6'>{robot}</sdf>")
        wait_until(lambda: len(follower.images) == 3, "a frame of the new robot")
        self.stand_still(server)
        self.assertNotIn("no message on", server.output())

    def test_a_topic_that_no_plugin_has_and_ctrl_c_while_waiting(self):
        server = self.start("--real_time_factor", "0", lockstep="answers",
                            lockstep_timeout=10 * LIMIT)
        follower = self.follow("/answers", EmptyMsg)
        server.call("unpause_physics", Empty)
        wait_until(lambda: len(follower.images) > 40, "forty frames")
        follower.close()
        mute = self.follow("/answers", EmptyMsg, delay=lambda number: None)
        wait_until(lambda: mute.images, "a frame that is not answered")
        self.stand_still(server)
        code, took = server.end()
        self.assertEqual(code, 0, server.output())
        self.assertLess(took, END_LIMIT)
        stamps = follower.stamps()
        self.assertEqual(stamps, [FRAME_PERIOD * (n + 1) for n in range(len(stamps))])

    def test_without_an_answer_it_warns_and_goes_on(self):
        server = self.start("--real_time_factor", "0", lockstep="/cmd_vel", lockstep_timeout=0.1)
        frames = []
        looker = rospy.Subscriber(IMAGES, Image, frames.append)
        self.addCleanup(looker.unregister)
        server.call("unpause_physics", Empty)
        wait_until(lambda: len(frames) >= 5, "frames")
        lines = [line for line in server.output().splitlines() if "no message on" in line]
        self.assertEqual(len(lines), 1, lines)
        self.assertIn("/cmd_vel within 0.1 s", lines[0])
        looker.unregister()
        before = server.call("get_world_properties", GetWorldProperties).sim_time
        wait_until(lambda: server.call("get_world_properties", GetWorldProperties).sim_time
                   > before + 20.0, "time that waits for nobody when nobody looks")

    def test_an_illegal_topic_is_one_line_and_exit_code_1(self):
        server = Gzserver(lockstep="no topic!")
        self.addCleanup(server.end)
        self.assertEqual(server.process.wait(LIMIT), 1)
        lines = server.output().strip().splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertIn("'no topic!', which is not a topic name", lines[0])


if __name__ == "__main__":
    rospy.init_node("lockstep_contract", disable_rostime=True)
    rostest.rosrun("bullet_sim_ros", "lockstep", Lockstep)
