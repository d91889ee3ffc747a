#!/usr/bin/env python3
"""Goals reached, not reached, cancelled and replaced, and what is missing on the way."""

import os
import re
import signal
import subprocess
import sys
import time
import unittest

import actionlib
import dynamic_reconfigure.client
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Quaternion
from made_up_robot import Robot
from move_base_msgs.msg import MoveBaseAction, RecoveryStatus
from nav_msgs.msg import Path
from nav_msgs.srv import GetPlan
from rosgraph_msgs.msg import Log
from running import address, alive, goal_at, pid_of, sends_to_us, wait_until
from std_srvs.srv import Empty

START, NEAR, FAR = (0.7, 0.7, 0.0), (1.3, 0.7, 0.0), (3.2, 1.0, 1.0)
CHAMBER, COLUMN, CRAMPED = (3.4, 3.4, 0.0), (2.0, 2.0, 0.0), (1.65, 2.0, 0.0)
ALL = "odom", "scan", "tf", "localisation"


class Story(unittest.TestCase):
    """One robot for all; each test waits until it stands."""

    @classmethod
    def setUpClass(cls):
        cls.lines = []
        rospy.Subscriber("rosout_agg", Log, lambda log: cls.lines.append(log.msg))
        cls.robot = Robot(START, *ALL)
        cls.client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        assert cls.client.wait_for_server(rospy.Duration(60))

    def setUp(self):
        self.robot.speaks = set(ALL)
        self.robot.pose, self.robot.velocity = np.array(START), np.zeros(3)
        del self.lines[:]
        time.sleep(0.5)

    def tearDown(self):
        self.client.cancel_all_goals()
        wait_until(self.robot.stands, "standing after the test")

    def drive(self, place=FAR):
        """Sends a goal and waits until the robot moves."""
        self.client.send_goal(goal_at(place))
        wait_until(lambda: self.robot.velocity[0] > 0.1, "driving")

    def wait_for_links(self, *topics):
        """What move_base says comes to these subscribers from now on."""
        names = {topic.resolved_name for topic in topics}
        wait_until(lambda: sends_to_us("move_base", names), f"links of {names}")

    def ended(self):
        """(state, text) of the goal."""
        self.assertTrue(self.client.wait_for_result(rospy.Duration(60.0)), "no result")
        return self.client.get_state(), self.client.get_goal_status_text()

    def test_reaches_a_goal(self):
        """And shows its paths."""
        seen, current = {}, []
        topics = [rospy.Subscriber(f"move_base/{topic}", Path, seen.setdefault(topic, []).append)
                  for topic in ("NavfnROS/plan", "DWAPlannerROS/global_plan",
                                "DWAPlannerROS/local_plan")]
        topics.append(rospy.Subscriber("move_base/current_goal", PoseStamped, current.append))
        self.wait_for_links(*topics)
        self.client.send_goal(goal_at(NEAR))
        self.assertEqual(self.ended(), (GoalStatus.SUCCEEDED, "Goal reached."))
        self.assertLess(np.hypot(*(self.robot.pose[:2] - NEAR[:2])), 0.1)
        self.assertTrue(self.robot.stands())
        self.assertEqual(current[0].pose.position.x, NEAR[0])
        for topic, messages in seen.items():
            self.assertTrue(messages and messages[0].poses, topic)

    def test_reaches_a_goal_given_in_its_own_frame_and_by_topic(self):
        """move_base_simple/goal, as rviz sends it."""
        topic = rospy.Publisher("move_base_simple/goal", PoseStamped, queue_size=1)
        wait_until(topic.get_num_connections, "somebody who takes goals")
        topic.publish(goal_at((0.5, 0.0, 0.0), "base_footprint").target_pose)
        wait_until(lambda: abs(self.robot.pose[0] - 1.2) < 0.06 and self.robot.stands(), "there")

    def test_unreachable_goal(self):
        """Each recovery is tried, then upstream's text."""
        tried = []
        self.wait_for_links(
            rospy.Subscriber("move_base/recovery_status", RecoveryStatus, tried.append))
        self.client.send_goal(goal_at(CHAMBER))
        self.assertEqual(self.ended(), (
            GoalStatus.ABORTED,
            "Failed to find a valid plan. Even after executing recovery behaviors."))
        self.assertEqual([(status.current_recovery_number, status.recovery_behavior_name)
                          for status in tried], [(0, "conservative_reset"), (1, "rotate_recovery")])
        self.assertEqual(tried[0].total_number_of_recoveries, 2)

    def test_goal_in_a_wall(self):
        """No other than an unreachable one."""
        self.client.send_goal(goal_at(COLUMN))
        self.assertEqual(self.ended(), (
            GoalStatus.ABORTED,
            "Failed to find a valid plan. Even after executing recovery behaviors."))

    def test_a_place_where_it_does_not_fit(self):
        """A velocity to turn with can always be found there; oscillation_timeout is off."""
        client = dynamic_reconfigure.client.Client("move_base", timeout=60)
        before = client.update_configuration({})
        client.update_configuration({"oscillation_timeout": 0.0, "controller_patience": 5.0,
                                     "recovery_behavior_enabled": False})
        self.addCleanup(client.update_configuration, before)
        self.client.send_goal(goal_at(CRAMPED))
        self.assertEqual(self.ended(), (
            GoalStatus.ABORTED,
            "Failed to find a valid control. Even after executing recovery behaviors."))

    def test_cancelled_goal(self):
        """The robot stands at once."""
        self.drive()
        self.client.cancel_goal()
        wait_until(self.robot.stands, "standing", 0.5)
        self.assertEqual(self.ended(), (GoalStatus.PREEMPTED, ""))

    def test_a_new_goal_while_moving(self):
        """The old one is preempted; the robot goes to the new one."""
        self.drive()
        ended = []
        second = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        second.wait_for_server()
        self.client.stop_tracking_goal()
        second.send_goal(goal_at(FAR), done_cb=lambda state, _: ended.append(
            (state, second.get_goal_status_text())))
        wait_until(lambda: second.get_state() == GoalStatus.ACTIVE, "active")
        self.client.send_goal(goal_at(NEAR))
        wait_until(lambda: ended, "the end of the first")
        self.assertEqual(ended[0], (
            GoalStatus.PREEMPTED, "This goal was canceled because another goal was received by "
                                  "the simple action server"))
        self.assertEqual(self.ended(), (GoalStatus.SUCCEEDED, "Goal reached."))

    def test_invalid_quaternion(self):
        """Refused at once, with upstream's text."""
        for q in (Quaternion(), Quaternion(0, 0, float("nan"), 1), Quaternion(1, 0, 0, 1)):
            goal = goal_at(FAR)
            goal.target_pose.pose.orientation = q
            for _ in range(10):  # actionlib loses a result that comes while send_goal still runs
                self.client.send_goal(goal)
                if self.client.wait_for_result(rospy.Duration(5.0)):
                    break
            self.assertEqual(self.ended(), (
                GoalStatus.ABORTED,
                "Aborting on goal because it was sent with an invalid quaternion"))

    def test_make_plan(self):
        """To a place, to no place, and to a place within the tolerance."""
        make_plan = rospy.ServiceProxy("move_base/make_plan", GetPlan)
        start, far, chamber = (goal_at(place).target_pose for place in (START, FAR, CHAMBER))
        poses = make_plan(start, far, 0.0).plan.poses
        self.assertGreater(len(poses), 50)
        self.assertAlmostEqual(poses[-1].pose.position.x, FAR[0])
        self.assertEqual(make_plan(start, chamber, 0.0).plan.poses, [])
        column = goal_at(COLUMN).target_pose
        poses = make_plan(start, column, 0.8).plan.poses
        self.assertEqual(poses[-1].pose.position.x, 2.0)
        self.assertGreater(len(poses), 10)

    def test_make_plan_in_a_frame_that_nobody_knows(self):
        """An empty plan, as upstream, and a line that names the frame."""
        make_plan = rospy.ServiceProxy("move_base/make_plan", GetPlan)
        for wrong in ("start", "goal"):
            poses = {"start": goal_at(START).target_pose, "goal": goal_at(FAR).target_pose}
            poses[wrong].header.frame_id = "nowhere"
            self.assertEqual(make_plan(poses["start"], poses["goal"], 0.0).plan.poses, [])
            wait_until(lambda wrong=wrong: [
                line for line in self.lines if f"the {wrong} is in frame 'nowhere'" in line],
                f"a line about the {wrong}")

    def test_clear_costmaps(self):
        """Answers, and a drive goes on after it."""
        rospy.ServiceProxy("move_base/clear_costmaps", Empty)()
        rospy.ServiceProxy("move_base/clear_unknown_space", Empty)()
        self.drive()

    def check_missing(self, thing, pattern):
        """Stands within 1 s, one line that names it, drives on when it is there again."""
        self.drive()
        self.robot.speaks.discard(thing)
        wait_until(self.robot.stands, f"standing without {thing}", 1.0)
        wait_until(lambda: [line for line in self.lines if re.search(pattern, line)],
                   f"a line that says {pattern}")
        time.sleep(1.0)
        self.assertTrue(self.robot.stands())
        said = [line for line in self.lines if line.startswith("no ")]
        self.assertEqual(len(said), 1, said)  # and none of what follows from it
        self.assertEqual(said[0].count("no "), 1, said)
        self.robot.speaks.add(thing)
        wait_until(lambda: self.robot.velocity[0] > 0.1, f"driving on with {thing}")

    def test_silent_laser(self):
        """A sensor of the costmap."""
        self.check_missing("scan", r"no LaserScan on /scan for \d+ s")

    def test_silent_odometry(self):
        """The robot's velocity is not known."""
        self.check_missing("odom", r"no odometry on /odom for \d+ s")

    def test_missing_transform(self):
        """The robot's pose is not known."""
        self.check_missing("tf", r"no new transform from odom to base_footprint for \d+ s")

    def test_silent_localisation(self):
        """amcl was killed."""
        self.check_missing("localisation", r"no new transform from map to odom for \d+ s")

    def test_z_killed_and_terminated(self):
        """The robot stands within 1 s; the client of one that was told to end hears of it."""
        for number in (signal.SIGKILL, signal.SIGTERM):
            self.check_ended_by(number)

    def check_ended_by(self, number):
        """Stands; ends in time; the one that is started in its place drives."""
        self.drive()
        node, process = address("move_base"), pid_of("move_base")
        os.kill(process, number)
        wait_until(self.robot.stands, f"standing after signal {number}", 1.0)
        if number == signal.SIGTERM:
            self.assertEqual(self.ended(), (
                GoalStatus.ABORTED, "Aborting on the goal because the node has been killed"))
        wait_until(lambda: not alive(process), "its end", 2.0)
        time.sleep(0.5)
        self.assertTrue(self.robot.stands())
        self.robot.pose = np.array(START)
        wait_until(lambda: address("move_base") not in (None, node), "a new one")
        type(self).client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        self.assertTrue(self.client.wait_for_server(rospy.Duration(60)))

    def test_unknown_planner(self):
        """One line with what there is, and an exit code."""
        rospy.set_param("/other/base_global_planner", "nowhere/Planner")
        ended = subprocess.run(["rosrun", "move_base", "move_base", "__name:=other"], timeout=60,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertNotEqual(ended.returncode, 0)
        self.assertIn("nowhere/Planner", ended.stdout)
        self.assertIn("navfn/NavfnROS", ended.stdout)
        self.assertNotIn("Traceback", ended.stdout)


if __name__ == "__main__":
    rospy.init_node("story")
    rostest.rosrun("move_base", "move_base_story", Story, sys.argv)
