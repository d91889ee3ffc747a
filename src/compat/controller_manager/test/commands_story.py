#!/usr/bin/env python3
"""controller_manager, controller_group and unspawner: upstream's story, in namespace /arm."""

import contextlib
import io
import signal
import unittest

import rospy
import rostest
from controller_manager import command_line, controller_manager_interface, groups
from fake_manager import INTERFACE, TYPE, FakeManager
from tool_process import Tool, run, until


def row(name, state):
    return f"'{name}' - '{INTERFACE}' ( {state} )\n"


class CommandsStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("commands_story")
        cls.manager = FakeManager("/arm")
        cls.manager.configure(c1="elbow", c2="elbow", c3="wrist")
        rospy.set_param("/arm/controller_groups",
                        {"g1": ["c1", "c3"], "g2": ["c2", "c3"], "g3": ["c1", "c2"]})

    def setUp(self):
        self.manager.reset()

    def ask(self, words):
        """Standard output and error of a command, called in this process: a new one takes 1 s."""
        command, *names = words.split()
        return self.outputs(command_line.run, command_line.SHORT.get(command, command), names)

    def ask_group(self, words):
        return self.outputs(groups.run, groups.arguments().parse_args(words.split()))

    def outputs(self, call, *arguments):
        with contextlib.redirect_stdout(io.StringIO()) as said, \
                contextlib.redirect_stderr(io.StringIO()) as reason:
            call(*arguments)
        return said.getvalue(), reason.getvalue()

    def assert_says(self, words, expected):
        self.assertEqual(self.ask(words), (expected, ""))

    def test_a_controllers_life(self):
        self.assert_says("list-types", f"{TYPE}\n")
        self.assert_says("list", "No controllers are loaded in mechanism control\n")
        self.assert_says("load c1", "Loaded 'c1'\n")
        self.assert_says("lc", row("c1", "initialized"))
        self.assert_says("start c1", "Started ['c1'] successfully\n")
        self.assert_says("stop c1", "Stopped ['c1'] successfully\n")
        self.assert_says("unload c1", "Unloaded 'c1' successfully\n")
        self.assert_says("spawn c1 c3", "Loaded 'c1'\nLoaded 'c3'\n"
                         "Started ['c1'] successfully\nStarted ['c3'] successfully\n")
        self.assert_says("list", row("c1", "running") + row("c3", "running"))
        self.assert_says("kill c1", "Stopped ['c1'] successfully\nUnloaded 'c1' successfully\n")
        self.assert_says("reload-libraries --restore", "Restore: True\nSuccessfully reloaded "
                         "libraries\nControllers restored to original state\n")
        self.assert_says("list", row("c3", "running"))
        self.assert_says("reload-libraries", "Restore: False\nSuccessfully reloaded libraries\n")
        self.assertEqual(self.manager.table, {})

    def test_refusals_name_their_cause(self):
        self.ask("spawn c1")
        for words, told, cause in (
                ("load c1", "Error when loading 'c1'\n", "it is loaded already (running)"),
                ("load c9", "Error when loading 'c9'\n", "parameter /arm/c9/type is not set"),
                ("unload c1", "Error when unloading 'c1'\n", "c1 is running"),
                ("unload c9", "Error when unloading 'c9'\n", "c9 is not loaded; loaded: c1"),
                ("start c9", "Error when starting ['c9'] and stopping []\n", "not loaded: c9"),
                ("stop c9", "Error when starting [] and stopping ['c9']\n", "not loaded: c9"),
                ("start c1", "Error when starting ['c1'] and stopping []\n", "running already: c1"),
                ("spawn c2", "Loaded 'c2'\nError when starting ['c2'] and stopping []\n",
                 "joint elbow is claimed by c1 and c2")):
            with self.subTest(words):
                said, reason = self.ask(words)
                self.assertEqual(said, told)
                self.assertIn(cause, reason)

    def test_exit_codes(self):
        code, said, _ = run(self, "controller_manager", "spawn", "c1", namespace="/arm")
        self.assertEqual((code, said), (0, "Loaded 'c1'\nStarted ['c1'] successfully\n"))
        code, said, reason = run(self, "controller_manager", "stop", "c9", namespace="/arm")
        self.assertEqual((code, said), (0, "Error when starting [] and stopping ['c9']\n"))
        self.assertIn("not loaded: c9", reason)
        code, said, _ = run(self, "controller_manager")
        self.assertEqual((code, said.startswith("Commands:")), (0, True))
        code, _, reason = run(self, "controller_manager", "lst")
        self.assertEqual(code, 1)
        self.assertIn("there is no command lst", reason)
        code, _, reason = run(self, "controller_manager", "load")
        self.assertEqual((code, reason),
                         (1, "controller_manager: load needs the name of a controller\n"))

    def test_no_manager_here(self):
        tool = Tool(self, "controller_manager", "list")
        tool.until_says("ROS_NAMESPACE=/arm before rosrun")
        self.assertIn("Nobody offers /controller_manager/list_controllers", tool.said)
        self.assertEqual(tool.end(signal.SIGINT), 130)
        self.assertNotIn("Traceback", tool.said)

    def test_groups(self):
        said, _ = self.ask_group("list")
        self.assertEqual(said, "Number of groups: 3\n  g1\n      c1\n      c3\n"
                         "  g2\n      c2\n      c3\n  g3\n      c1\n      c2\n")
        said, _ = self.ask_group("spawn g1")
        self.assertEqual(said, "Loaded 'c1'\nLoaded 'c3'\nStarted ['c1'] successfully\n"
                         "Started ['c3'] successfully\n")
        said, _ = self.ask_group("switch g2")
        self.assertEqual(said, "Loaded 'c2'\nStarted ['c2'] successfully\n"
                         "Stopped ['c1'] successfully\n")
        said, reason = self.ask_group("switch g3")
        self.assertEqual(said, "Error when starting ['c1'] and stopping ['c3']\n")
        self.assertIn("joint elbow is claimed by c1 and c2", reason)
        self.assertEqual(run(self, "controller_group", "switch", "g9", namespace="/arm"), (
            0, "", "There is no controller defined in group g9; groups: g1, g2, g3\n"))

    def test_unspawner(self):
        self.ask("spawn c1 c3")
        unspawner = Tool(self, "unspawner", "c1", "c8", namespace="/arm")
        unspawner.until_says("Inhibiting controllers: c1")
        until(lambda: self.manager.states() == {"c1": "stopped", "c3": "running"}, "the stop")
        self.assertIn("c8 is not loaded (yet); loaded: c1, c3", unspawner.said)
        self.ask("start c1")
        until(lambda: self.manager.states()["c1"] == "stopped", "the second stop")
        self.assertEqual(unspawner.end(signal.SIGTERM), 0)
        self.assertEqual(self.manager.states(), {"c1": "running", "c3": "running"})
        self.assertEqual(run(self, "unspawner")[0], 1)

    def test_python_module(self):
        self.outputs(self.use_python_module)

    def use_python_module(self):
        self.assertTrue(controller_manager_interface.load_controller("c1"))
        self.assertTrue(controller_manager_interface.start_controllers(["c1"]))
        self.assertFalse(controller_manager_interface.start_controller("c1"))
        self.assertTrue(controller_manager_interface.stop_controllers(["c1"]))
        self.assertTrue(controller_manager_interface.unload_controller("c1"))


if __name__ == "__main__":
    rostest.rosrun("controller_manager", "commands_story", CommandsStory)
