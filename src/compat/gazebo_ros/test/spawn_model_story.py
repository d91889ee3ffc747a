#!/usr/bin/env python3
"""spawn_model as a process, against a fake /gazebo: requests, lines, exit codes."""

import math
import os
import signal
import subprocess
import time
import unittest

import rospy
import rostest
from fake_gazebo import FakeGazebo
from gazebo_msgs.msg import ModelStates
from roslib.packages import find_node

URDF = '<robot name="r"><link name="base"/></robot>'
PLAIN = ("-urdf", "-param", "robot_description", "-model", "car")
LIMIT = 60.0  # s


def until(condition, what):
    """Waits for a condition; fails with a word on what did not come."""
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what} did not come within {LIMIT:.0f} s")
        time.sleep(0.02)


class SpawnModelStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("story")
        cls.gazebo = FakeGazebo("/gazebo")
        cls.program = find_node("gazebo_ros", "spawn_model")[0]
        rospy.set_param("/robot_description", URDF)
        rospy.set_param("/tb3_0/robot_description", URDF)

    def setUp(self):
        self.gazebo.reset()

    def start(self, *words, namespace="/"):
        environment = os.environ | {"ROS_NAMESPACE": namespace, "PYTHONUNBUFFERED": "1"}
        process = subprocess.Popen(
            [self.program, *words], env=environment, text=True, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.kill)
        return process

    def run_to_end(self, *words, namespace="/", text=""):
        process = self.start(*words, namespace=namespace)
        said, _ = process.communicate(text, timeout=LIMIT)
        return process.returncode, said

    def request(self, number=0):
        return self.gazebo.calls.queue[number][1]

    def test_spawn_from_a_parameter(self):
        # conforms: spawn_model, spawn_model/-urdf, spawn_model/-param, spawn_model/-model
        # conforms: spawn_model/-x, spawn_model/-z, spawn_model/-Y, spawn_model/log lines
        # conforms: spawn_model/exit codes, gazebo_ros.gazebo_interface/spawn_urdf_model_client
        code, said = self.run_to_end(*PLAIN, "-x", "1", "-z", "-0.5", "-Y", str(math.pi / 2))
        self.assertEqual((code, self.gazebo.names()), (0, ["spawn_urdf_model"]))
        request = self.request()
        self.assertEqual((request.model_name, request.robot_namespace, request.reference_frame),
                         ("car", "/", ""))
        self.assertIn('<link name="base" />', request.model_xml)
        self.assertEqual((request.initial_pose.position.x, request.initial_pose.position.z),
                         (1.0, -0.5))
        self.assertAlmostEqual(request.initial_pose.orientation.z, math.sqrt(0.5))
        for line in ("Loading model XML from ros parameter robot_description",
                     "Waiting for service /gazebo/spawn_urdf_model",
                     "Calling service /gazebo/spawn_urdf_model",
                     "Spawn status: spawn_urdf_model answered"):
            self.assertIn(line, said)

    def test_in_a_namespace(self):
        # conforms: spawn_model/-robot_namespace
        code, _ = self.run_to_end(*PLAIN, namespace="/tb3_0")
        self.assertEqual((code, self.request().robot_namespace), (0, "/tb3_0/"))

    def test_sdf_from_stdin_and_from_the_model_path(self):
        # conforms: spawn_model/-sdf, spawn_model/-stdin, spawn_model/-database
        # conforms: spawn_model/-reference_frame, spawn_model/-robot_namespace
        # conforms: spawn_model/log lines
        # conforms: gazebo_ros.gazebo_interface/spawn_sdf_model_client
        code, said = self.run_to_end("-sdf", "-stdin", "-model", "box", text="<sdf/>")
        self.assertEqual((code, self.gazebo.names()), (0, ["spawn_sdf_model"]))
        self.assertIn("Loading model XML from stdin", said)
        code, said = self.run_to_end("-sdf", "-database", "coke_can", "-model", "can",
                                  "-reference_frame", "car", "-robot_namespace", "r")
        self.assertEqual((code, self.gazebo.names()), (0, ["spawn_sdf_model"] * 2))
        self.assertIn("Loading model XML from Gazebo Model Database", said)
        request = self.request(1)
        self.assertIn("model://coke_can", request.model_xml)
        self.assertEqual((request.reference_frame, request.robot_namespace), ("car", "r"))

    def test_the_simulator_refuses(self):
        # conforms: spawn_model/log lines, spawn_model/exit codes
        self.gazebo.failing.add("spawn_urdf_model")
        code, said = self.run_to_end(*PLAIN, "-unpause", "-J", "wheel", "1")
        self.assertEqual((code, self.gazebo.names()), (1, ["spawn_urdf_model"]))
        self.assertIn("Spawn status: spawn_urdf_model answered", said)
        self.assertIn("Spawn service failed. Exiting.", said)

    def test_the_service_breaks(self):
        # conforms: spawn_model/log lines, spawn_model/exit codes
        self.gazebo.broken.add("spawn_urdf_model")
        code, said = self.run_to_end(*PLAIN)
        self.assertEqual(code, 1)
        self.assertIn("Service call failed: ", said)
        self.assertIn("Spawn service failed. Exiting.", said)

    def test_a_missing_parameter(self):
        # conforms: spawn_model/-param
        code, said = self.run_to_end("-urdf", "-param", "robot_descripton", "-model", "car")
        self.assertEqual((code, self.gazebo.names()), (1, []))
        self.assertIn("/robot_descripton is not set; there are: "
                      "/robot_description, /tb3_0/robot_description", said)
        self.assertNotIn("Traceback", said)

    def test_a_missing_file_and_a_broken_one(self):
        # conforms: spawn_model/-file, spawn_model/log lines, spawn_model/exit codes
        code, said = self.run_to_end("-urdf", "-file", "/none.urdf", "-model", "car")
        self.assertEqual(code, 1)
        self.assertIn("FATAL", said)
        self.assertIn("Loading model XML from file /none.urdf", said)
        self.assertIn("Error: specified file /none.urdf does not exist", said)
        code, said = self.run_to_end("-urdf", "-stdin", "-model", "car", text="<robot>")
        self.assertEqual(code, 1)
        self.assertIn("Invalid XML: ", said)

    def test_a_joint_position_that_is_no_number(self):
        # conforms: spawn_model/-J
        code, said = self.run_to_end(*PLAIN, "-J", "wheel", "up")
        self.assertEqual((code, said), (1, "Error: -J wheel up: up is not a number\n"))

    def test_joints_then_unpause(self):
        # conforms: spawn_model/-J, spawn_model/-unpause, spawn_model/log lines
        # conforms: gazebo_ros.gazebo_interface/set_model_configuration_client
        code, said = self.run_to_end(*PLAIN, "-unpause", "-J", "left", "0.5", "-J", "right", "-1")
        self.assertEqual((code, self.gazebo.names()),
                         (0, ["spawn_urdf_model", "set_model_configuration", "unpause_physics"]))
        request = self.request(1)
        self.assertEqual(
            (request.model_name, request.urdf_param_name, request.joint_names,
             request.joint_positions), ("car", "", ["left", "right"], (0.5, -1.0)))
        for line in ("Waiting for service /gazebo/set_model_configuration", "(upstream issue 93)",
                     "Calling service /gazebo/set_model_configuration",
                     "Set model configuration status: set_model_configuration answered"):
            self.assertIn(line, said)
        self.assertIn("Unpausing physics", said)

    def test_joints_or_unpause_fail(self):
        # conforms: spawn_model/-J, spawn_model/-unpause, spawn_model/log lines
        # conforms: spawn_model/exit codes
        self.gazebo.failing.add("set_model_configuration")
        code, said = self.run_to_end(*PLAIN, "-unpause", "-J", "left", "0.5")
        self.assertEqual((code, self.gazebo.names()[1:]), (1, ["set_model_configuration"]))
        self.assertIn("SetModelConfiguration service failed. Exiting.", said)
        self.gazebo.broken.add("unpause_physics")
        code, said = self.run_to_end(*PLAIN, "-unpause")
        self.assertEqual(code, 1)
        self.assertIn("Unpause physics service call failed: ", said)

    def test_wait_for_another_model(self):
        # conforms: spawn_model/-wait, spawn_model/log lines
        process = self.start(*PLAIN, "-wait", "table")
        until(self.gazebo.states.get_num_connections, "the subscription to model_states")
        self.gazebo.states.publish(ModelStates(name=["ground_plane"]))
        time.sleep(0.3)  # three polls: the wrong model must not be enough
        self.assertEqual(self.gazebo.names(), [])
        self.gazebo.states.publish(ModelStates(name=["ground_plane", "table"]))
        said, _ = process.communicate(timeout=LIMIT)
        self.assertEqual((process.returncode, self.gazebo.names()), (0, ["spawn_urdf_model"]))
        self.assertIn("Waiting for model table before proceeding.", said)

    def start_before_the_simulator(self, gazebo):
        process = self.start(*PLAIN, "-gazebo_namespace", gazebo)
        line = next(line for line in process.stdout if "Waiting" in line)
        self.assertIn(f"Waiting for service {gazebo}/spawn_urdf_model", line)
        time.sleep(0.1)  # several looks: none of them may find it
        self.assertIsNone(process.poll())
        return process

    def test_a_simulator_that_comes_later(self):
        # conforms: spawn_model/-gazebo_namespace
        process = self.start_before_the_simulator("/late")
        late = FakeGazebo("/late")
        said, _ = process.communicate(timeout=LIMIT)
        self.assertEqual((process.returncode, late.names()), (0, ["spawn_urdf_model"]), said)

    def test_a_simulator_in_another_namespace_is_named(self):
        FakeGazebo("/tb3_0/gazebo")
        process = self.start_before_the_simulator("/one/gazebo")
        in_a_group = self.start(*PLAIN, "-gazebo_namespace", "/one/gazebo",
                                namespace="/tb3_0")
        said = ("Nobody offers /one/gazebo/spawn_urdf_model. A simulator runs as: /gazebo, "
                "/tb3_0/gazebo (spawn_model: -gazebo_namespace ")
        self.assertIn(f"{said}/gazebo)", process.stdout.readline())
        lines = [in_a_group.stdout.readline() for _ in range(3)]
        self.assertTrue(any(f"{said}/tb3_0/gazebo)" in line for line in lines), lines)

    def test_stopped_before_there_is_a_simulator(self):
        # conforms: spawn_model/exit codes
        process = self.start_before_the_simulator("/never")
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, 1)
        self.assertIn("spawn_model: stopped before it was done", said)

    def test_stopped_while_waiting(self):
        # conforms: spawn_model/-wait, spawn_model/exit codes
        process = self.start(*PLAIN, "-wait", "table")
        until(self.gazebo.states.get_num_connections, "the subscription to model_states")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LIMIT)
        self.assertEqual((process.returncode, self.gazebo.names()), (0, []))

    def test_bond_deletes_at_the_end(self):
        # conforms: spawn_model/-b, spawn_model/log lines
        process = self.start(*PLAIN, "-b")
        line = next(line for line in process.stdout if "Waiting for shutdown" in line)
        self.assertIn("Waiting for shutdown to delete model car", line)
        self.assertEqual(self.gazebo.names(), ["spawn_urdf_model"])
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(self.gazebo.names()[1:], ["delete_model"])
        self.assertEqual(self.request(1).model_name, "car")
        self.assertIn("Deleting model car", said)

    def test_a_bond_whose_model_cannot_be_deleted(self):
        # conforms: spawn_model/-b, spawn_model/log lines, spawn_model/exit codes
        self.gazebo.broken.add("delete_model")
        process = self.start(*PLAIN, "-b")
        next(line for line in process.stdout if "Waiting for shutdown" in line)
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=LIMIT)
        self.assertEqual((process.returncode, self.gazebo.names()[1:]), (0, ["delete_model"]))
        self.assertIn("Delete model service call failed: ", said)


if __name__ == "__main__":
    rostest.rosrun("gazebo_ros", "spawn_model_story", SpawnModelStory)
