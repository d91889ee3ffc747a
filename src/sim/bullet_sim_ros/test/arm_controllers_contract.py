#!/usr/bin/env python3
"""Trajectory and gripper controllers over ROS, on arms moved by position, velocity and effort."""

import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from contracts import LIMIT, Manager, pass_time, wait_until
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryGoal,
    FollowJointTrajectoryResult,
    GripperCommandAction,
    GripperCommandGoal,
    JointTolerance,
    JointTrajectoryControllerState,
)
from control_msgs.srv import QueryTrajectoryState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

ARMS = ("effort_arm", "velocity_arm", "position_arm")
HOME = (0.0, 0.0)


def trajectory(*points, joints=("shoulder", "elbow"), start=None):
    """Points are (time, positions) or (time, positions, velocities)."""
    msg = JointTrajectory(joint_names=list(joints))
    msg.header.stamp = start or rospy.Time()
    for time, *values in points:
        msg.points.append(JointTrajectoryPoint(
            time_from_start=rospy.Duration.from_sec(time),
            **dict(zip(("positions", "velocities"), values, strict=False))))
    return msg


class Arm:
    """One arm's controllers, used as clients do."""

    def __init__(self, name):
        self.name = name
        self.manager = Manager(name)
        self.manager.run("arm_controller")
        self.states = []
        prefix = f"/{name}/arm_controller"
        rospy.Subscriber(f"{prefix}/state", JointTrajectoryControllerState, self.states.append,
                         queue_size=10)
        self.command = rospy.Publisher(f"{prefix}/command", JointTrajectory, queue_size=1)
        self.follow = self.client(f"{prefix}/follow_joint_trajectory", FollowJointTrajectoryAction)
        self.grip = None
        if name != "velocity_arm":  # upstream has no gripper by velocity
            self.manager.run("gripper_controller")
            self.grip = self.client(f"/{name}/gripper_controller/gripper_cmd",
                                    GripperCommandAction)
        self.feedback = []
        wait_until(lambda: self.states and self.command.get_num_connections(), name)

    @staticmethod
    def client(name, kind):
        client = actionlib.SimpleActionClient(name, kind)
        assert client.wait_for_server(rospy.Duration(LIMIT)), name
        return client

    def send(self, msg, client=None, **tolerances):
        self.feedback = []
        (client or self.follow).send_goal(
            FollowJointTrajectoryGoal(trajectory=msg, **tolerances),
            feedback_cb=self.feedback.append)

    def end(self, client=None):
        """(status, error code, error text) of the last goal."""
        client = client or self.follow
        assert client.wait_for_result(rospy.Duration(LIMIT)), "no result"
        result = client.get_result()
        return client.get_state(), result.error_code, result.error_string

    def go_home(self):
        """From wherever the last test left it."""
        self.command.publish(JointTrajectory())
        pass_time(0.3)
        off = [JointTolerance(name=joint, position=-1.0) for joint in ("shoulder", "elbow")]
        self.send(trajectory((1.0, HOME, (0.0, 0.0))), path_tolerance=off,
                  goal_time_tolerance=rospy.Duration(5))
        return self.end()

    def positions(self):
        return self.states[-1].actual.positions

    def desired(self):
        return self.states[-1].desired.positions


class ArmControllers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arms = {name: Arm(name) for name in ARMS}
        cls.arm = cls.arms["effort_arm"]

    def setUp(self):
        self.arm.manager.run("arm_controller")
        self.assertEqual(self.arm.go_home()[1], FollowJointTrajectoryResult.SUCCESSFUL)

    def assert_near(self, positions, wanted, delta=0.03):
        for position, value in zip(positions, wanted, strict=True):
            self.assertAlmostEqual(position, value, delta=delta)

    # --- reaching

    def test_a_trajectory_succeeds_by_each_interface(self):
        # conforms: controllers/effort_controllers/JointTrajectoryController
        # conforms: controllers/velocity_controllers/JointTrajectoryController
        # conforms: controllers/position_controllers/JointTrajectoryController
        path = trajectory((0.6, (0.4, -0.3), (0.3, -0.2)), (1.2, (0.6, -0.6), (0.0, 0.0)))
        for arm in self.arms.values():
            arm.send(path)
        for name, arm in self.arms.items():
            status, code, text = arm.end()
            self.assertEqual((status, code), (GoalStatus.SUCCEEDED, 0), f"{name}: {text}")
            self.assertGreater(len(arm.feedback), 10)
            wait_until(lambda arm=arm: arm.desired() == (0.6, -0.6), f"the end of {name}")
            self.assert_near(arm.positions(), (0.6, -0.6), 0.025)

    def test_joints_in_another_order(self):
        self.arm.send(trajectory((0.6, (-0.2, 0.3), (0.0, 0.0)), joints=("elbow", "shoulder")))
        self.assertEqual(self.arm.end()[1], 0)
        self.assert_near(self.arm.positions(), (0.3, -0.2))

    def test_a_start_in_the_future_is_waited_for(self):
        self.arm.send(trajectory((0.5, (0.3, 0.0), (0.0, 0.0)),
                                 start=rospy.Time.now() + rospy.Duration(0.5)))
        pass_time(0.35)
        self.assert_near(self.arm.desired(), HOME, 0.001)
        self.assertEqual(self.arm.end()[1], 0)
        self.assert_near(self.arm.positions(), (0.3, 0.0))

    def test_the_trajectory_can_be_asked_for(self):
        self.arm.send(trajectory((2.0, (0.4, 0.0))))
        wait_until(lambda: self.arm.desired()[0] > 0.02, "the start")
        query = rospy.ServiceProxy("/effort_arm/arm_controller/query_state", QueryTrajectoryState)
        now = rospy.Time.now()
        ahead, far = query(now + rospy.Duration(0.5)), query(now + rospy.Duration(60))
        self.assertEqual(ahead.name, ["shoulder", "elbow"])
        self.assertAlmostEqual(ahead.velocity[0], 0.2, places=6)
        self.assertEqual(far.position, (0.4, 0.0))
        self.arm.follow.cancel_goal()

    # --- failing

    def test_a_violated_path_aborts(self):
        tight = [JointTolerance(name="shoulder", position=0.005)]
        self.arm.send(trajectory((0.15, (0.8, 0.0), (0.0, 0.0))), path_tolerance=tight)
        status, code, text = self.arm.end()
        self.assertEqual((status, code), (
            GoalStatus.ABORTED, FollowJointTrajectoryResult.PATH_TOLERANCE_VIOLATED))
        self.assertIn("shoulder: path position error", text)
        pass_time(1.0)
        self.assert_near(self.arm.positions(), (0.8, 0.0))  # the trajectory went on

    def test_a_violated_goal_aborts_after_its_time(self):
        beyond = (0.6, (3.0, 0.0), (0.0, 0.0))  # the joint's limit is 2.5
        off = [JointTolerance(name="shoulder", position=-1.0)]
        self.arm.send(trajectory(beyond), path_tolerance=off,
                      goal_time_tolerance=rospy.Duration(0.2))
        status, code, text = self.arm.end()
        self.assertEqual((status, code), (
            GoalStatus.ABORTED, FollowJointTrajectoryResult.GOAL_TOLERANCE_VIOLATED))
        self.assertIn("shoulder: goal position error", text)

    def test_invalid_goals_are_rejected_and_say_why(self):
        past = rospy.Time.from_sec(0.001)
        for msg, wanted, words in (
                (trajectory((1.0, (0.1,)), joints=("shoulder",)), -2, "shoulder, elbow"),
                (trajectory((1.0, (0.1, 0.2)), joints=("shoulder", "wrist")), -2, "wrist"),
                (trajectory((1.0, (0.1,))), -1, "1 positions for 2 joints"),
                (trajectory((1.0, HOME), (0.5, HOME)), -1, "strictly increasing"),
                (trajectory((1.0, (float("nan"), 0.0))), -1, "not finite numbers"),
                (trajectory((0.5, HOME), start=past), -1, "in the past")):
            self.arm.send(msg)
            status, code, text = self.arm.end()
            self.assertEqual((status, code), (GoalStatus.REJECTED, wanted), text)
            self.assertIn(words, text)

    def test_a_stopped_controller_rejects_and_a_stop_preempts(self):
        self.arm.send(trajectory((5.0, (0.5, 0.5))))
        wait_until(lambda: self.arm.follow.get_state() == GoalStatus.ACTIVE, "an active goal")
        self.assertTrue(self.arm.manager.switch(stop=["arm_controller"]))
        self.assertEqual(self.arm.end()[0], GoalStatus.PREEMPTED)
        self.arm.send(trajectory((1.0, HOME)))
        status, code, text = self.arm.end()
        self.assertEqual((status, code), (GoalStatus.REJECTED, -1))
        self.assertIn("not running", text)
        self.assertTrue(self.arm.manager.switch(start=["arm_controller"]))

    # --- changing one's mind

    def test_a_new_goal_preempts(self):
        other = Arm.client("/effort_arm/arm_controller/follow_joint_trajectory",
                           FollowJointTrajectoryAction)
        self.arm.send(trajectory((5.0, (1.0, 0.0))))
        wait_until(lambda: self.arm.follow.get_state() == GoalStatus.ACTIVE, "an active goal")
        self.arm.send(trajectory((0.8, (-0.3, 0.2), (0.0, 0.0))), client=other)
        self.assertEqual(self.arm.end()[0], GoalStatus.PREEMPTED)
        self.assertEqual(self.arm.end(other)[:2], (GoalStatus.SUCCEEDED, 0))
        self.assert_near(self.arm.positions(), (-0.3, 0.2))

    def test_cancelling_stops_where_the_arm_is(self):
        self.arm.send(trajectory((5.0, (1.5, 0.0))))
        wait_until(lambda: self.arm.desired()[0] > 0.2, "a good part of the way")
        self.arm.follow.cancel_goal()
        self.assertEqual(self.arm.end()[0], GoalStatus.PREEMPTED)
        pass_time(0.6)
        stopped = self.arm.positions()
        self.assertLess(stopped[0], 0.6)
        pass_time(0.3)
        self.assert_near(self.arm.positions(), stopped, 0.01)

    def test_a_topic_command_preempts_and_an_empty_one_holds(self):
        self.arm.send(trajectory((5.0, (1.5, 0.0))))
        wait_until(lambda: self.arm.desired()[0] > 0.1, "the start")
        self.arm.command.publish(trajectory((4.0, (-1.0, 0.0))))
        self.assertEqual(self.arm.end()[0], GoalStatus.PREEMPTED)
        wait_until(lambda: self.arm.desired()[0] < -0.1, "the way back")
        self.arm.command.publish(JointTrajectory())
        pass_time(0.6)
        held = self.arm.positions()
        self.assertGreater(held[0], -0.5)
        pass_time(0.3)
        self.assert_near(self.arm.positions(), held, 0.01)

    # --- gripper

    def grip(self, arm, position, max_effort=15.0):
        goal = GripperCommandGoal()
        goal.command.position, goal.command.max_effort = position, max_effort
        arm.grip.send_goal(goal)
        self.assertTrue(arm.grip.wait_for_result(rospy.Duration(LIMIT)))
        return arm.grip.get_state(), arm.grip.get_result()

    def test_grippers_reach(self):
        # conforms: controllers/effort_controllers/GripperActionController
        # conforms: controllers/position_controllers/GripperActionController
        for name in ("effort_arm", "position_arm"):
            for position in (0.05, 0.01):
                status, result = self.grip(self.arms[name], position)
                self.assertEqual(status, GoalStatus.SUCCEEDED, name)
                self.assertTrue(result.reached_goal and not result.stalled)
                self.assertAlmostEqual(result.position, position, delta=0.003)

    def test_a_stall_is_told(self):
        status, result = self.grip(self.arm, 0.2)  # the joint ends at 0.08
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertTrue(result.stalled and not result.reached_goal)
        self.assertAlmostEqual(result.position, 0.08, delta=0.005)

    # --- loading

    def test_a_controller_that_was_loaded_again_serves_again(self):
        topic = "/effort_arm/arm_controller/follow_joint_trajectory/result"
        self.assertTrue(self.arm.manager.switch(stop=["arm_controller"]))
        self.assertTrue(self.arm.manager.unload("arm_controller"))
        self.assertNotIn(topic, [name for name, _ in rospy.get_published_topics()])
        self.arm.manager.run("arm_controller")
        again = Arm.client("/effort_arm/arm_controller/follow_joint_trajectory",
                           FollowJointTrajectoryAction)
        self.arm.send(trajectory((0.5, HOME, (0.0, 0.0))), client=again)
        self.assertEqual(self.arm.end(again)[:2], (GoalStatus.SUCCEEDED, 0))

    def test_what_cannot_be_loaded(self):
        good = rospy.get_param("/effort_arm/arm_controller")
        for number, change in enumerate((
                {"joints": ["shoulder", "wrist"]}, {"joints": []}, {"gains": {}},
                {"type": "position_controllers/JointTrajectoryController"},
                {"type": "pos_vel_controllers/JointTrajectoryController"},
                {"constraints": {"goal_time": "long"}})):
            rospy.set_param(f"/effort_arm/bad{number}", {**good, **change})
            self.assertFalse(self.arm.manager.load(f"bad{number}"), change)


if __name__ == "__main__":
    rospy.init_node("arm_controllers_contract")
    rostest.rosrun("bullet_sim_ros", "arm_controllers", ArmControllers)
