"""The bench under ros_control: the manager's rules, and controllers that do what they are told."""

import subprocess
import unittest

import rospy
from contracts import BEST_EFFORT, LIMIT, STRICT, Manager, Rosout, call, wait_until
from control_msgs.msg import JointControllerState, PidState
from controller_manager_msgs.srv import ListControllerTypes, ReloadControllerLibraries
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Pose
from rosgraph_msgs.msg import Clock
from roslib.packages import find_node
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64, Float64MultiArray
from std_srvs.srv import Empty


def dynparam(*words):
    done = subprocess.run([find_node("dynamic_reconfigure", "dynparam")[0], *words], text=True,
                          capture_output=True, timeout=LIMIT, check=True)
    return done.stdout


class RosControl(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rosout = Rosout()
        cls.manager = Manager("bench")
        cls.spawn()

    @classmethod
    def spawn(cls, old="", new="", then="Loaded gazebo_ros_control."):
        """The URDF parameter comes late: spawning and time do not wait for it."""
        urdf = rospy.get_param("bench_urdf").replace(old, new)
        answer = call("/gazebo/spawn_urdf_model", SpawnModel, "bench", urdf, "", Pose(), "")
        assert answer.success, answer.status_message
        cls.rosout.wait_for("waiting for model URDF in parameter [bench_description]")
        before = rospy.wait_for_message("/clock", Clock, LIMIT).clock
        wait_until(lambda: rospy.wait_for_message("/clock", Clock, LIMIT).clock > before, "time")
        assert "Loaded gazebo_ros_control." not in cls.rosout.lines
        rospy.set_param("bench_description", urdf)
        cls.rosout.wait_for(then)

    def setUp(self):
        self.rosout.lines.clear()
        self.joints = {}
        self.publishers = {}
        states = rospy.Subscriber("/bench/joint_states", JointState, self.take_joints)
        self.addCleanup(states.unregister)
        self.addCleanup(self.manager.clear)

    # --- help

    def take_joints(self, msg):
        self.joints = dict(zip(msg.name, zip(msg.position, msg.velocity, msg.effort)))

    def start(self, *names):
        names = ["joint_state_controller", *names]
        self.assertTrue(all(map(self.manager.load, names)), self.rosout.lines)
        self.assertTrue(self.manager.switch(start=names), self.rosout.lines)
        wait_until(lambda: self.joints, "joint states")

    def send(self, controller, value):
        kind = Float64 if isinstance(value, float) else Float64MultiArray
        if controller not in self.publishers:
            made = rospy.Publisher(f"/bench/{controller}/command", kind, queue_size=1)
            self.addCleanup(made.unregister)
            wait_until(made.get_num_connections, f"{controller} to listen")
            self.publishers[controller] = made
        self.publishers[controller].publish(kind(data=value))

    def reaches(self, joint, index, value, within):
        wait_until(lambda: abs(self.joints[joint][index] - value) < within,
                   f"{joint}[{index}] = {value}; it is {self.joints[joint]}")

    def position_reaches(self, joint, value, within=0.01):
        self.reaches(joint, 0, value, within)

    def velocity_reaches(self, joint, value, within=0.05):
        self.reaches(joint, 1, value, within)

    # --- the manager

    def test_types_are_listed(self):
        # conforms: controller_manager services/list_controller_types
        types = call("/bench/controller_manager/list_controller_types", ListControllerTypes)
        self.assertIn("effort_controllers/JointPositionController", types.types)
        self.assertEqual(len(types.types), len(types.base_classes))

    def test_a_controller_lives_as_upstreams(self):
        # conforms: libgazebo_ros_control.so/robotNamespace, libgazebo_ros_control.so/robotParam
        # conforms: controller_manager services/load_controller
        # conforms: controller_manager services/unload_controller
        # conforms: controller_manager services/switch_controller
        # conforms: controller_manager services/list_controllers
        manager, name = self.manager, "left_velocity"
        self.assertTrue(manager.load(name))
        self.assertFalse(manager.load(name))
        self.assertEqual(manager.states(), {name: "initialized"})
        self.assertTrue(manager.switch(start=[name]))
        self.assertEqual(manager.states(), {name: "running"})
        claimed = manager.list()[0].claimed_resources
        self.assertEqual(claimed[0].hardware_interface, "hardware_interface::EffortJointInterface")
        self.assertEqual(claimed[0].resources, ["left_wheel"])
        self.assertFalse(manager.unload(name))
        self.rosout.wait_for("Could not unload controller", "because it is still running")
        self.assertTrue(manager.switch(stop=[name]))
        self.assertEqual(manager.states(), {name: "stopped"})
        self.assertTrue(manager.unload(name))
        self.assertNotIn(f"/bench/{name}/command", dict(rospy.get_published_topics()))
        self.assertFalse(manager.unload(name))

    def test_what_cannot_be_loaded_says_why(self):
        for name, *parts in (
            ("missing", "type was not specified", "/bench/missing/type"),
            ("mistyped", "'effort_controllers/JointPositonController' does not exist",
             "did you mean effort_controllers/JointPositionController?"),
            ("no_joint", "Initializing controller 'no_joint' failed", "left_weel", "left_wheel,"),
            ("other_interface", "right_wheel", "takes velocity commands", "left_wheel, pendulum"),
            ("no_gains", "/bench/no_gains/pid/p is not set"),
            ("no_rate", "Parameter 'publish_rate' not set"),
        ):
            self.assertFalse(self.manager.load(name), name)
            self.rosout.wait_for(f"'{name}'", *parts)
        self.assertEqual(self.manager.list(), [])

    def test_one_joint_is_claimed_by_one_controller(self):
        # conforms: controller_manager services/reload_controller_libraries
        manager = self.manager
        self.start("left_velocity")
        for name in ("left_effort", "both_efforts"):
            manager.load(name)
        for strictness in (STRICT, BEST_EFFORT):
            self.assertFalse(manager.switch(start=["both_efforts"], strictness=strictness))
        self.rosout.wait_for("resource conflict", "'left_wheel' is claimed by 'left_velocity'",
                             "'both_efforts'")
        self.assertTrue(manager.switch(start=["left_effort"], stop=["left_velocity"]))
        states = manager.states()
        self.assertEqual((states["left_effort"], states["left_velocity"]), ("running", "stopped"))
        call("/bench/controller_manager/reload_controller_libraries", ReloadControllerLibraries,
             force_kill=True)
        self.assertEqual(manager.list(), [])

    def test_a_switch_waits_while_physics_is_paused(self):
        self.manager.load("left_effort")
        call("/gazebo/pause_physics", Empty)
        self.assertFalse(self.manager.switch(start=["left_effort"], timeout=0.3))
        self.assertEqual(self.manager.states(), {"left_effort": "initialized"})
        call("/gazebo/unpause_physics", Empty)
        self.assertTrue(self.manager.switch(start=["left_effort"], timeout=LIMIT))

    # --- controllers

    def test_joint_states_come_at_their_rate_in_alphabetical_order(self):
        # conforms: controllers/joint_state_controller/JointStateController
        self.start()
        first = rospy.wait_for_message("/bench/joint_states", JointState, LIMIT)
        second = rospy.wait_for_message("/bench/joint_states", JointState, LIMIT)
        self.assertEqual(first.name, ["hinge", "left_wheel", "pendulum", "right_wheel"])
        periods = (second.header.stamp - first.header.stamp).to_sec() / 0.02
        self.assertAlmostEqual(periods, round(periods), places=6)
        self.assertGreater(periods, 0.5)

    def test_velocity_by_effort_and_its_state_topics(self):
        # conforms: controllers/effort_controllers/JointVelocityController
        self.start("left_velocity")
        self.send("left_velocity", 6.0)
        self.velocity_reaches("left_wheel", 6.0)
        state = rospy.wait_for_message("/bench/left_velocity/state", JointControllerState, LIMIT)
        self.assertEqual((state.set_point, state.p, state.time_step), (6.0, 1.0, 0.001))
        self.assertAlmostEqual(state.process_value, 6.0, delta=0.1)
        terms = rospy.wait_for_message("/bench/left_velocity/pid/state", PidState, LIMIT)
        self.assertEqual(terms.p_term, 1.0)
        self.send("left_velocity", float("nan"))
        self.rosout.wait_for("/bench/left_velocity", "not finite")

    def test_gains_change_while_it_runs(self):
        # conforms: controllers/effort_controllers/JointPositionController
        self.start("pendulum_position")
        self.assertIn("'p': 30.0", dynparam("get", "/bench/pendulum_position/pid"))
        self.send("pendulum_position", 0.5)
        self.position_reaches("pendulum", 0.5)
        dynparam("set", "/bench/pendulum_position/pid", "{p: 0, i: 0, d: 0.05}")
        self.position_reaches("pendulum", 0.0)  # gravity alone
        self.assertEqual(rospy.get_param("/bench/pendulum_position/pid/p"), 0.0)

    def test_a_command_beyond_the_limits_goes_to_the_limit(self):
        # conforms: controllers/position_controllers/JointPositionController
        self.start("hinge_position", "right_velocity")
        self.send("hinge_position", 2.0)
        self.position_reaches("hinge", 0.6, within=1e-3)

    def test_a_command_times_out_where_the_parameter_says_so(self):
        # conforms: controllers/velocity_controllers/JointVelocityController
        self.start("right_velocity")
        speeds = []  # all of them: it turns for a moment only
        states = rospy.Subscriber("/bench/joint_states", JointState, lambda msg: speeds.append(
            msg.velocity[msg.name.index("right_wheel")]))
        self.addCleanup(states.unregister)
        wait_until(lambda: speeds, "joint states")
        self.send("right_velocity", 9.0)
        wait_until(lambda: any(abs(speed - 9.0) < 0.05 for speed in speeds), "9 rad/s")
        self.velocity_reaches("right_wheel", 0.0)

    def test_a_group_takes_a_number_for_each_joint(self):
        # conforms: controllers/effort_controllers/JointGroupEffortController
        self.start("both_efforts")
        self.send("both_efforts", [0.0, 0.5, 1.0])
        self.rosout.wait_for("Dimension of command (3) does not match number of joints (2)")
        self.send("both_efforts", [0.0, 0.5])
        self.reaches("pendulum", 2, 0.5, within=1e-9)

    def test_a_stopped_controller_leaves_no_effort_behind(self):
        # conforms: controllers/effort_controllers/JointEffortController
        self.start("left_effort")
        self.send("left_effort", 0.2)
        self.reaches("left_wheel", 2, 0.2, within=1e-9)
        self.manager.switch(stop=["left_effort"])
        self.reaches("left_wheel", 2, 0.0, within=1e-9)

    def test_emergency_stop_and_its_release(self):
        # conforms: libgazebo_ros_control.so/eStopTopic
        self.start("right_velocity", "hinge_position", "left_velocity")
        stop = rospy.Publisher("/bench/stop", Bool, queue_size=1)
        self.addCleanup(stop.unregister)
        self.addCleanup(stop.publish, False)  # whatever fails here, the others go on
        wait_until(stop.get_num_connections, "the emergency stop")
        self.send("left_velocity", 6.0)
        self.velocity_reaches("left_wheel", 6.0)
        stop.publish(True)
        self.reaches("left_wheel", 2, 0.0, within=1e-9)
        hinge = self.joints["hinge"][0]
        self.send("hinge_position", hinge - 0.3)
        self.send("right_velocity", 5.0)
        before = rospy.wait_for_message("/bench/joint_states", JointState, LIMIT).header.stamp
        wait_until(lambda: (rospy.wait_for_message("/bench/joint_states", JointState, LIMIT)
                            .header.stamp - before).to_sec() > 0.1, "a tenth of a second")
        self.assertAlmostEqual(self.joints["hinge"][0], hinge)
        self.assertAlmostEqual(self.joints["right_wheel"][1], 0.0)
        stop.publish(False)
        self.velocity_reaches("left_wheel", 0.0)  # started anew: the old command is forgotten

    def test_time_may_be_reset(self):
        self.start("left_velocity")
        self.send("left_velocity", 3.0)
        self.velocity_reaches("left_wheel", 3.0)
        call("/gazebo/reset_simulation", Empty)
        self.joints = {}
        wait_until(lambda: self.joints, "joint states after the reset")
        self.velocity_reaches("left_wheel", 3.0)

    # --- the model

    def delete(self):
        call("/gazebo/delete_model", DeleteModel, "bench")
        wait_until(lambda: not [name for name, _ in rospy.get_published_topics("/bench")],
                   "no topics")
        rospy.delete_param("bench_description")
        self.rosout.lines.clear()

    def respawn(self):
        self.delete()
        self.spawn()

    def test_all_ends_with_the_model_and_begins_with_the_next(self):
        self.start("left_velocity")
        self.respawn()
        self.assertEqual(self.manager.list(), [])

    def test_the_control_period_is_what_controllers_see(self):
        # conforms: libgazebo_ros_control.so/controlPeriod
        self.addCleanup(self.respawn)
        self.delete()
        self.spawn("<eStopTopic>", "<controlPeriod>0.01</controlPeriod><eStopTopic>")
        self.rosout.wait_for("Desired controller update period (0.01 s) is slower")
        self.start("left_velocity")
        state = rospy.wait_for_message("/bench/left_velocity/state", JointControllerState, LIMIT)
        self.assertAlmostEqual(state.time_step, 0.01)

    def test_a_transmission_of_a_joint_that_is_not_there_switches_the_plugin_off(self):
        self.addCleanup(self.respawn)
        self.delete()
        self.spawn('<joint name="hinge"><hard', '<joint name="henge"><hard',
                   then="Could not initialize robot simulation interface")
        self.rosout.wait_for('"henge" which is not in the gazebo model', "hinge")
        with self.assertRaises(rospy.ROSException):
            rospy.wait_for_service("/bench/controller_manager/list_controllers", 0.5)
