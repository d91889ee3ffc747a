#!/usr/bin/env python3
"""spawner as a process and as a launch node: what it loads, starts, says and takes down."""

import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import rospy
import rostest
from controller_manager_msgs.srv import SwitchControllerResponse
from fake_manager import TYPE, FakeManager
from std_msgs.msg import Bool
from tool_process import LIMIT, Tool, run, until

LAUNCHED = {"/rrbot": ("joint_state_controller", "joint1_position_controller"),
            "/racecar": ("joint_state_controller",)}
UP = {"c1": "running", "c3": "running"}


class SpawnerStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("spawner_story")
        cls.manager = FakeManager("/arm")
        cls.manager.configure(c1="elbow", c2="elbow", c3="wrist")
        cls.launched = []  # the managers of the nodes in spawner.test
        for namespace, names in LAUNCHED.items():
            for name in names:
                rospy.set_param(f"{namespace}/{name}", {"type": TYPE, "joint": name})
            manager = FakeManager(namespace)
            cls.launched.append((manager, dict.fromkeys(names, "running")))

    def setUp(self):
        self.manager.reset()
        self.addCleanup(self.manager.unpaused.set)

    def spawner(self, *words, namespace="/arm"):
        return Tool(self, "spawner", *words, namespace=namespace)

    def until_states(self, expected, manager=None):
        table = manager or self.manager
        until(lambda: table.states() == expected, f"{expected}")

    def file(self, text):
        file = tempfile.NamedTemporaryFile("w", suffix=".yaml")  # noqa: SIM115
        self.addCleanup(file.close)
        file.write(text)
        file.flush()
        return file.name

    def test_up_and_down(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            spawner = self.spawner("c1", "c3")
            self.until_states(UP)
            spawner.until_says("Started controllers: c1, c3")
            request = self.manager.switches[-1]
            self.assertEqual((request.strictness, request.timeout), (2, 0.0))
            self.assertEqual(spawner.end(number), 0)
            self.assertEqual(self.manager.table, {})
            for line in (
                    "Controller Spawner: Waiting for service controller_manager/load_controller",
                    "Controller Spawner: Waiting for service controller_manager/switch_controller",
                    "Controller Spawner: Waiting for service controller_manager/unload_controller",
                    "Loading controller: c1", "Controller Spawner: Loaded controllers: c1, c3",
                    "Shutting down spawner. Stopping and unloading controllers...",
                    "Stopping all controllers...", "Unloading all loaded controllers...",
                    "Trying to unload c3", "Succeeded in unloading c1"):
                self.assertIn(line, spawner.said)

    def test_rosnode_kill(self):
        spawner = self.spawner("c1", "__name:=mine")
        spawner.until_says("Started controllers: c1")
        subprocess.run(["rosnode", "kill", "/arm/mine"], check=True, capture_output=True)
        self.assertEqual(spawner.end(), 0)
        self.assertEqual(self.manager.table, {})

    def test_launch_lines(self):
        for manager, states in self.launched:
            self.until_states(states, manager)

    def test_namespace_and_stopped(self):
        spawner = self.spawner("--namespace=/arm", "--stopped", "c1", namespace="/")
        spawner.until_says("Loaded controllers: c1")
        self.until_states({"c1": "initialized"})
        self.assertIn("Waiting for service /arm/controller_manager/load_controller", spawner.said)
        self.assertEqual((spawner.end(signal.SIGINT), self.manager.table), (0, {}))

    def test_yaml_file(self):
        place = self.file(f"c5: {{type: {TYPE}, joint: thumb}}\nc6: {{type: {TYPE}, joint: toe}}")
        spawner = self.spawner(place, "c1")
        self.until_states({"c1": "running", "c5": "running", "c6": "running"})
        self.assertEqual(rospy.get_param("/arm/c6/joint"), "toe")
        spawner.end(signal.SIGINT)

    def test_yaml_files_that_cannot_be_taken(self):
        for text, why in (("c8: [", ", line "), ("[c8]", "controllers' names"), ("", "is empty"),
                          ("c8: {type: }", "no empty value"), ("c8: 1\n1: 2\n", "string keys")):
            with self.subTest(text):
                place = self.file(text)
                code, _, reason = run(self, "spawner", place, namespace="/arm")
                self.assertEqual(code, 1)
                self.assertIn(place, reason)
                self.assertIn(why, reason)
        code, _, reason = run(self, "spawner", "/none.yaml", namespace="/arm")
        self.assertEqual((code, "/none.yaml" in reason), (1, True))
        self.assertEqual(self.manager.table, {})

    def test_some_cannot_be_loaded(self):
        rospy.set_param("/arm/c7/type", "effort_controllers/JointEfortController")
        spawner = self.spawner("c9", "c7", "c1")
        spawner.until_says("Started controllers: c1")
        self.assertIn("Failed to load c9: parameter /arm/c9/type is not set", spawner.said)
        self.assertIn("there is no controller type effort_controllers/JointEfortController; "
                      f"is {TYPE} meant?", spawner.said)
        self.assertEqual(spawner.end(signal.SIGINT), 0)

    def test_a_joint_claimed_twice(self):
        spawner = self.spawner("c1", "c2")
        spawner.until_says("Failed to start controllers: c1, c2: "
                           "joint elbow is claimed by c1 and c2")
        self.assertEqual((spawner.end(signal.SIGINT), self.manager.table), (0, {}))

    def test_stopped_by_somebody_else(self):
        spawner = self.spawner("c1", "c3")
        self.until_states(UP)
        self.manager.table["c1"].state = "stopped"
        self.assertEqual((spawner.end(signal.SIGINT), self.manager.table), (0, {}))

    def test_ends_while_the_world_is_paused(self):
        self.manager.unpaused.clear()
        spawner = self.spawner("c1")
        until(lambda: self.manager.switches, "the switch")
        self.assertEqual(spawner.end(signal.SIGINT), 0)
        self.assertIn("The controller manager has not answered for 10 s", spawner.said)

    def test_running_when_the_world_is_paused(self):
        spawner = self.spawner("c1")
        spawner.until_says("Started controllers: c1")
        self.manager.unpaused.clear()
        self.assertEqual(spawner.end(signal.SIGINT), 0)
        self.assertIn("Could not stop c1 within 5 s: is the world paused?", spawner.said)
        self.assertIn("Failed to unload c1: c1 is running", spawner.said)

    def test_no_manager(self):
        code, _, reason = run(self, "spawner", "--timeout", "0.5", "c1", "--shutdown-timeout", "3")
        self.assertEqual(code, 0)
        for line in ("couldn't find the expected controller_manager ROS interface.",
                     "Nobody offers /controller_manager/load_controller.",
                     "A controller manager answers in: /arm", "--namespace=/arm",
                     "DEPRECATION warning: --shutdown-timeout has no effect."):
            self.assertIn(line, reason)

    def test_manager_that_is_gone_at_the_end(self):
        manager = FakeManager("/gone")
        manager.configure(c1="elbow")
        spawner = self.spawner("c1", namespace="/gone")
        self.until_states({"c1": "running"}, manager)
        manager.close()
        self.assertEqual(spawner.end(signal.SIGINT), 0)
        self.assertIn("The controller manager has ended, its controllers with it:", spawner.said)
        self.assertNotIn("[WARN]", spawner.said)

    def test_world_that_ends_at_the_same_time(self):
        spawner = self.spawner("c1", "c3")
        spawner.until_says("Started controllers: c1, c3")
        with unittest.mock.patch.object(self.manager, "switch_controller",
                                        lambda _request: SwitchControllerResponse(False)):
            self.assertEqual(spawner.end(signal.SIGINT), 0)
        self.assertIn("Could not stop c1, c3: the world is ending", spawner.said)
        self.assertNotIn("[WARN]", spawner.said)

    def test_a_signal_counts_although_its_interruption_was_swallowed(self):
        node = subprocess.Popen([sys.executable, str(Path(__file__).with_name("swallower.py"))],
                                stdout=subprocess.PIPE, text=True)
        self.addCleanup(node.kill)
        self.assertEqual(node.stdout.readline(), "at work\n")
        node.send_signal(signal.SIGINT)
        said, _ = node.communicate(timeout=LIMIT)
        self.assertEqual((said, node.returncode), ("swallowed\nundone\n", 0))

    def test_before_the_clock(self):
        rospy.set_param("/use_sim_time", True)
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        spawner = self.spawner("--timeout", "0.3", "c1", namespace="/late")
        spawner.until_says("Waiting for /clock to be available...")
        rospy.set_param("/late/c1", {"type": TYPE, "joint": "elbow"})
        manager = FakeManager("/late")
        self.addCleanup(manager.close)
        self.until_states({"c1": "running"}, manager)
        self.assertEqual(spawner.end(signal.SIGINT), 0)

    def test_wait_for_a_topic(self):
        go = rospy.Publisher("/arm/go", Bool, queue_size=1)
        spawner = self.spawner("--wait-for", "go", "--timeout", "1", "c1")
        until(go.get_num_connections, "the subscription to go")
        go.publish(False)
        spawner.until_says('hasn\'t heard anything true from its "wait for" topic (/arm/go)')
        self.assertEqual(self.manager.table, {})
        go.publish(True)
        self.until_states({"c1": "running"})
        self.assertEqual(spawner.end(signal.SIGINT), 0)


if __name__ == "__main__":
    rostest.rosrun("controller_manager", "spawner_story", SpawnerStory)
