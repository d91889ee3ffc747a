"""What the services of /gazebo promise, asked over ROS."""

import math
import unittest

import dynamic_reconfigure.client
import rospy
from contracts import LIMIT, wait_until
from gazebo_msgs.msg import LinkStates, ModelState, ModelStates
from gazebo_msgs.srv import (
    DeleteModel,
    GetModelProperties,
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    SetModelConfiguration,
    SetModelState,
    SpawnModel,
)
from geometry_msgs.msg import Pose, Twist
from roscpp.srv import GetLoggers, SetLoggerLevel
from rosgraph_msgs.msg import Clock, Log
from std_srvs.srv import Empty

BOX = """<robot name="box"><link name="link">
<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry>{visual}</geometry></visual>
<collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>{extra}</robot>"""
PLAIN = BOX.format(visual='<box size="0.2 0.2 0.2"/>', extra="")
ARM = """<robot name="arm"><link name="base">{i}</link><link name="tip">{i}</link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>""".format(
    i='<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
      "</inertial>")


def service(name, kind):
    rospy.wait_for_service(f"/gazebo/{name}", LIMIT)
    return rospy.ServiceProxy(f"/gazebo/{name}", kind)


class Services(unittest.TestCase):
    log: list[str] = []
    clock = 0.0

    @classmethod
    def setUpClass(cls):
        # Once for all: rospy, told to leave and join a topic again and again, now and then does
        # not connect.
        cls.rosout = rospy.Subscriber("/rosout", Log, lambda msg: cls.log.append(msg.msg))
        cls.clocks = rospy.Subscriber("/clock", Clock, cls.on_clock)
        cls.spawn = service("spawn_urdf_model", SpawnModel)
        cls.delete = service("delete_model", DeleteModel)
        cls.state = service("get_model_state", GetModelState)
        wait_until(lambda: cls.rosout.get_num_connections() and cls.clock > 0, "a running clock")

    def setUp(self):
        self.log.clear()

    def tearDown(self):
        service("unpause_physics", Empty)()
        for name in service("get_world_properties", GetWorldProperties)().model_names:
            if name != "ground_plane":
                self.delete(name)

    @classmethod
    def on_clock(cls, msg):
        cls.clock = msg.clock.to_sec()

    def put(self, name="box", xml=PLAIN, z=1.0, frame=""):
        pose = Pose()
        pose.position.z = z
        return self.spawn(name, xml, "", pose, frame)

    # --- spawning and deleting

    def test_spawn_fall_and_delete(self):
        answer = self.put()
        self.assertTrue(answer.success, answer.status_message)
        self.assertEqual(answer.status_message, "SpawnModel: Successfully spawned entity")
        wait_until(lambda: abs(self.state("box", "").pose.position.z - 0.1) < 0.005, "a landing")
        self.assertEqual(self.delete("box").status_message,
                         "DeleteModel: successfully deleted model")
        self.assertEqual(self.delete("box").status_message, "DeleteModel: model does not exist")

    def test_spawn_while_paused(self):
        service("pause_physics", Empty)()
        self.assertTrue(self.put().success)
        self.assertEqual(self.state("box", "").pose.position.z, 1.0)

    def test_the_same_name_twice(self):
        self.put()
        again = self.put()
        self.assertFalse(again.success)
        self.assertEqual(again.status_message, "SpawnModel: Failure - entity already exists.")

    def test_a_reference_frame_that_is_not_there(self):
        answer = self.put(frame="nowhere")
        self.assertFalse(answer.success)
        self.assertIn("reference reference_frame not found", answer.status_message)

    def test_pose_relative_to_another_model(self):
        service("pause_physics", Empty)()
        self.put("low", z=1.0)
        self.put("high", z=2.0, frame="low")
        self.assertAlmostEqual(self.state("high", "").pose.position.z, 3.0)
        self.assertAlmostEqual(self.state("high", "low").pose.position.z, 2.0)

    def test_broken_urdf_is_one_answer_and_the_node_lives_on(self):
        for xml in ("<robot name='x'><link name='a'>", "<robot name='x'><joint name='j' "
                    "type='fixed'><parent link='a'/><child link='b'/></joint></robot>"):
            answer = self.put(xml=xml)
            self.assertFalse(answer.success)
            self.assertNotIn("\n", answer.status_message)
        with self.assertRaisesRegex(rospy.ServiceException, "entity format is invalid"):
            self.put(xml="<sdf version='1.6'/>")
        self.assertTrue(self.put().success)

    def test_texts_that_are_no_models(self):
        spawn_sdf = service("spawn_sdf_model", SpawnModel)
        answer = spawn_sdf("x", "hello", "", Pose(), "")
        self.assertFalse(answer.success)
        self.assertIn("input model_xml not SDF or URDF", answer.status_message)
        mesh = '<mesh filename="package://no_such_package/a.stl"/>'
        with self.assertRaisesRegex(rospy.ServiceException, "urdf reference package name does not"):
            self.put(xml=BOX.format(visual=mesh, extra=""))

    def test_a_light_is_spawned_as_a_light(self):
        spawn_sdf = service("spawn_sdf_model", SpawnModel)
        lamp = "<sdf version='1.6'><light type='point' name='l'/></sdf>"
        self.assertTrue(spawn_sdf("lamp", lamp, "", Pose(), "").success)
        self.assertFalse(spawn_sdf("lamp", lamp, "", Pose(), "").success)

    def test_a_model_without_a_wanted_name_keeps_its_own(self):
        self.assertTrue(self.put(name="", xml=PLAIN).success)
        again = self.put(name="", xml=PLAIN)
        self.assertEqual(again.status_message, "SpawnModel: Failure - entity already exists.")
        self.assertTrue(self.state("box", "").success)

    def test_a_broken_plugin_leaves_the_model_and_a_topic_name_is_checked(self):
        extra = ('<gazebo><plugin name="p" filename="libgazebo_ros_joint_state_publisher.so">'
                 "<robotNamespace>a b</robotNamespace></plugin></gazebo>")
        self.assertTrue(self.put(xml=BOX.format(visual='<box size="1 1 1"/>', extra=extra)).success)
        wait_until(lambda: any("not a legal topic name" in line for line in self.log), "an error")

    def test_a_missing_mesh_is_one_warning_and_the_model_spawns(self):
        mesh = '<mesh filename="package://gazebo_ros/meshes/not_there.stl"/>'
        self.assertTrue(self.put(xml=BOX.format(visual=mesh, extra="")).success)
        wait_until(lambda: any("not_there.stl" in line for line in self.log), "a warning")
        self.assertEqual(sum("not_there.stl" in line for line in self.log), 1)

    def test_an_unknown_plugin_is_one_warning_and_the_model_spawns(self):
        extra = '<gazebo><plugin name="p" filename="libno_such.so"/></gazebo>'
        xml = BOX.format(visual='<box size="1 1 1"/>', extra=extra)
        self.assertTrue(self.put(xml=xml).success)
        wait_until(lambda: any("libno_such.so" in line for line in self.log), "a warning")
        self.assertEqual(sum("libno_such.so" in line for line in self.log), 1)

    # --- states

    def test_unknown_models_and_frames(self):
        self.assertEqual(self.state("nobody", "").status_message,
                         "GetModelState: model does not exist")
        set_state = service("set_model_state", SetModelState)
        self.assertEqual(set_state(ModelState(model_name="nobody")).status_message,
                         "SetModelState: model does not exist")
        self.put()
        self.assertIn("reference relative_entity_name not found",
                      self.state("box", "nowhere").status_message)
        answer = set_state(ModelState(model_name="box", reference_frame="nowhere"))
        self.assertIn("specified reference frame entity does not exist", answer.status_message)

    def test_set_state_by_service_and_by_topic(self):
        service("pause_physics", Empty)()
        self.put()
        state = ModelState(model_name="box")
        state.pose.position.x, state.twist.linear.y = 2.5, 0.5
        self.assertTrue(service("set_model_state", SetModelState)(state).success)
        answer = self.state("box", "world")
        self.assertAlmostEqual(answer.pose.position.x, 2.5)
        self.assertAlmostEqual(answer.twist.linear.y, 0.5)
        topic = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=1, latch=True)
        state.pose.position.x = -1.0
        topic.publish(state)
        wait_until(lambda: abs(self.state("box", "").pose.position.x + 1.0) < 1e-6, "the move")

    def test_a_pose_that_is_no_number_is_refused(self):
        self.put()
        state = ModelState(model_name="box")
        for value in (math.nan, math.inf, 1e200):
            state.pose.position.x = value
            self.assertFalse(service("set_model_state", SetModelState)(state).success)

    def test_calls_are_counted_per_model(self):
        self.put()
        first = self.state("box", "").header.seq
        self.assertEqual(self.state("box", "").header.seq, first + 1)

    def test_joint_positions_are_set_at_once(self):
        service("pause_physics", Empty)()
        self.put("arm", ARM)
        configure = service("set_model_configuration", SetModelConfiguration)
        self.assertTrue(configure("arm", "", ["hinge", "unknown"], [0.5, 1.0]).success)
        self.assertIn("different lengths", configure("arm", "", ["hinge"], []).status_message)
        service("unpause_physics", Empty)()
        links = rospy.wait_for_message("/gazebo/link_states", LinkStates, LIMIT)
        tip = links.pose[links.name.index("arm::tip")]
        self.assertAlmostEqual(2 * math.atan2(tip.orientation.z, tip.orientation.w), 0.5, places=2)

    def test_state_topics_name_everything(self):
        self.put("arm", ARM)
        models = rospy.wait_for_message("/gazebo/model_states", ModelStates, LIMIT)
        self.assertEqual(models.name, ["ground_plane", "arm"])
        links = rospy.wait_for_message("/gazebo/link_states", LinkStates, LIMIT)
        self.assertEqual(links.name, ["ground_plane::link", "arm::base", "arm::tip"])
        self.assertIsInstance(models.twist[0], Twist)

    # --- what every node offers, and reconfigure

    def test_loggers(self):
        # conforms: /gazebo/get_loggers, /gazebo/set_logger_level
        level = service("set_logger_level", SetLoggerLevel)
        for wanted in ("warn", "info"):
            level("rosout", wanted)
            loggers = service("get_loggers", GetLoggers)().loggers
            self.assertIn(("rosout", wanted.upper()), [(one.name, one.level) for one in loggers])

    def test_a_client_of_dynamic_reconfigure(self):
        # conforms: /gazebo reconfigure/set_parameters, /gazebo reconfigure/gravity_z
        client = dynamic_reconfigure.client.Client("/gazebo", timeout=LIMIT)
        self.addCleanup(client.close)
        self.assertEqual(client.get_configuration(LIMIT)["gravity_z"], -9.8)
        self.assertEqual(client.update_configuration({"gravity_z": -1.6})["gravity_z"], -1.6)
        physics = service("get_physics_properties", GetPhysicsProperties)()
        self.assertEqual((physics.gravity.z, physics.time_step), (-1.6, 0.001))
        self.assertEqual(rospy.get_param("/gazebo/gravity_z"), -1.6)
        client.update_configuration({"gravity_z": -9.8})

    # --- the world

    def test_world_and_model_properties(self):
        self.put("arm", ARM)
        world = service("get_world_properties", GetWorldProperties)()
        self.assertEqual(world.model_names, ["ground_plane", "arm"])
        self.assertTrue(world.rendering_enabled)
        model = service("get_model_properties", GetModelProperties)
        arm = model("arm")
        self.assertEqual((arm.body_names, arm.joint_names, arm.is_static),
                         (["base", "tip"], ["hinge"], False))
        self.assertTrue(model("ground_plane").is_static)
        self.assertEqual(model("x").status_message, "GetModelProperties: model does not exist")

    def test_pause_means_that_time_stands_still(self):
        service("pause_physics", Empty)()
        properties = service("get_world_properties", GetWorldProperties)
        before = properties().sim_time
        rospy.rostime.wallsleep(0.3)
        self.assertEqual(properties().sim_time, before)
        service("unpause_physics", Empty)()
        wait_until(lambda: properties().sim_time > before, "time going on")

    def test_reset_world_and_reset_simulation(self):
        self.put(z=2.0)
        wait_until(lambda: self.state("box", "").pose.position.z < 1.5, "the fall")
        service("pause_physics", Empty)()
        properties = service("get_world_properties", GetWorldProperties)
        time = properties().sim_time
        service("reset_world", Empty)()
        self.assertAlmostEqual(self.state("box", "").pose.position.z, 2.0)
        self.assertEqual(properties().sim_time, time)
        service("reset_simulation", Empty)()
        self.assertEqual(properties().sim_time, 0.0)
        service("unpause_physics", Empty)()
        wait_until(lambda: 0 < self.clock < time, "a clock that was set back")
        states = []
        watcher = rospy.Subscriber("/gazebo/model_states", ModelStates, states.append)
        wait_until(lambda: len(states) > 10, "model_states that go on")
        before = self.clock
        wait_until(lambda: self.clock > before, "a clock that goes on")
        watcher.unregister()
