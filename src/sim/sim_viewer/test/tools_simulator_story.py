#!/usr/bin/env python3
"""The tools show what is true of the waffle on the course, and steer the simulator's time."""

import math
import sys
import time
import unittest

import rospy
import rostest
from background import wait_until
from gazebo_msgs.srv import GetModelState, GetPhysicsProperties
from nav_msgs.msg import Odometry
from tool_link import ToolLink

X = "/odom/pose/pose/position/x"
ONE_STEP = 0.001  # s, of the course's physics


class ToolsSimulator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_message("/odom", Odometry, 60.0)
        url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.link = ToolLink(url)
        cls.status = cls.link.watch("status")

    @classmethod
    def tearDownClass(cls):
        cls.link.close()

    def paused(self):
        return rospy.ServiceProxy("/gazebo/get_physics_properties", GetPhysicsProperties)().pause

    def test_the_graph_leads_from_the_follower_to_gazebo(self):
        graph = self.link.watch("graph")
        arrows = {("n/follower", "t/cmd_vel"), ("t/cmd_vel", "n/gazebo"),
                  ("t/camera/rgb/image_raw", "n/follower")}
        graph.until(lambda data: arrows <= {(e["from"], e["to"]) for e in data["edges"]},
                    "the follower's arrows")
        graph.stop()

    def test_a_plot_has_odometry_at_its_simulated_times(self):
        true = {}
        subscriber = rospy.Subscriber("/odom", Odometry, lambda message: true.update(
            {message.header.stamp.to_sec(): message.pose.pose.position.x}))
        plot = self.link.watch("plot", paths=[X])
        wait_until(lambda: sum(len(event[X]) for event in plot.events) > 60, "samples")
        plot.stop()
        subscriber.unregister()
        samples = [sample for event in plot.events for sample in event[X] if sample[0] in true]
        self.assertGreater(len(samples), 40)
        self.assertEqual([value for _, value in samples], [true[moment] for moment, _ in samples])

    def test_the_tree_of_frames_has_odometry_at_its_rate(self):
        tf = self.link.watch("tf")
        rows = tf.until(lambda rows: any(row["frame"] == "base_footprint" and row["rate"] > 20
                                         and abs(row["age"]) < 0.5 for row in rows),
                        "the robot's frame, up to date")
        tf.stop()
        row = next(row for row in rows if row["frame"] == "base_footprint")
        self.assertEqual((row["parent"], row["publisher"]), ("odom", "/gazebo"))

    def test_time_pauses_steps_and_goes_on(self):
        self.status.until(lambda data: data["simulator"] and data["factor"]
                          and abs(data["factor"] - 1.0) < 0.3, "real time")
        self.link.data("pause", paused=True)
        self.addCleanup(self.link.ask, "pause", paused=False)
        wait_until(lambda: self.status.events[-1]["paused"], "the page says that time stands")
        self.assertTrue(self.paused())
        time.sleep(0.3)
        before = rospy.get_time()
        step = self.link.data("step", steps=1)
        self.assertTrue(self.paused())
        self.assertAlmostEqual(step["from"], before, delta=0.011)
        self.assertAlmostEqual(step["to"] - step["from"], ONE_STEP, delta=1e-9)
        wait_until(lambda: abs(self.status.events[-1]["time"] - step["to"]) < 1e-6,
                   "the page shows the step's time")
        long = self.link.data("step", steps=500)
        self.assertAlmostEqual(long["to"] - long["from"], 500 * ONE_STEP, delta=1e-9)
        self.assertIn("steps is 0", self.link.error("step", steps=0))
        self.link.data("pause", paused=False)
        wait_until(lambda: not self.paused() and rospy.get_time() > before + 0.6, "time goes on")

    def test_a_reset_puts_the_robot_back(self):
        read = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)

        def away():
            place = read("turtlebot3_waffle", "world").pose.position
            return math.hypot(place.x, place.y)

        wait_until(lambda: away() > 0.1, "the robot drives")
        self.link.data("pause", paused=True)
        self.addCleanup(self.link.ask, "pause", paused=False)
        self.link.data("reset", what="world")
        wait_until(lambda: away() < 0.02, "it stands where it began")
        self.assertIn("there are world, simulation", self.link.error("reset", what="all"))


if __name__ == "__main__":
    rospy.init_node("tools_simulator_story")
    rostest.rosrun("sim_viewer", "tools_simulator", ToolsSimulator, sys.argv)
