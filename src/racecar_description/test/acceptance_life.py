"""A controller's life by the real tools and the real manager: what works, what is refused."""

import unittest

import rospy
from acceptance_car import CONTROLLERS, WHEELS, call, controller_states
from acceptance_tools import Spawner, manager, run, slow_down, spawn_all
from controller_manager_msgs.srv import (
    LoadController,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)

STRICT, BEST_EFFORT = SwitchControllerRequest.STRICT, SwitchControllerRequest.BEST_EFFORT
REAR = WHEELS[0]  # of the left rear wheel
EFFORT = "hardware_interface::EffortJointInterface"
SECOND = "second_of_left_rear"  # a controller that claims the same joint


def load(name):
    return call("/racecar/controller_manager/load_controller", LoadController, name).ok


def unload(name):
    return call("/racecar/controller_manager/unload_controller", UnloadController, name).ok


def switch(start=(), stop=(), strictness=STRICT):
    return call("/racecar/controller_manager/switch_controller", SwitchController,
                start_controllers=start, stop_controllers=stop, strictness=strictness).ok


class Life(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.spawner = spawn_all()
        cls.addClassCleanup(cls.spawner.end)
        cls.addClassCleanup(slow_down(0.2))  # the processor is for the tools

    def setUp(self):
        self.assertEqual(set(controller_states().values()), {"running"})

    def test_1_list_and_switch(self):
        self.spawner.wait_for(f"Started controllers: {', '.join(CONTROLLERS)}")
        rows = manager("list").splitlines()
        self.assertEqual(len(rows), 7)
        self.assertIn(f"'{REAR}' - '{EFFORT}' ( running )", rows)
        self.assertEqual(manager("stop", REAR), f"Stopped ['{REAR}'] successfully\n")
        self.assertEqual(controller_states()[REAR], "stopped")
        self.assertEqual(manager("start", REAR), f"Started ['{REAR}'] successfully\n")

    def test_2_wrong_names(self):
        self.assertEqual(manager("start", "nobody"),
                         "Error when starting ['nobody'] and stopping []\n")
        self.assertEqual(manager("stop", "nobody"),
                         "Error when starting [] and stopping ['nobody']\n")
        self.assertEqual(manager("load", "nobody"), "Error when loading 'nobody'\n")
        self.assertEqual(manager("unload", "nobody"), "Error when unloading 'nobody'\n")
        self.assertFalse(load("nobody") or unload("nobody") or switch(["nobody"]))
        self.assertTrue(switch(["nobody"], strictness=BEST_EFFORT))
        other = Spawner("nobody")
        self.addCleanup(other.end)
        other.wait_for("Failed to load nobody")
        other.wait_for("/racecar/nobody/type")  # the parameter that is missing
        self.assertIsNone(other.process.poll())
        self.assertEqual(other.end(), 0)
        code, _, reason = run("spawner", "--namespace=/nobody", "--timeout=0.5", REAR)
        self.assertEqual(code, 0)
        self.assertIn("couldn't find the expected controller_manager ROS interface", reason)
        self.assertIn("/racecar", reason)  # where a manager does answer
        self.assertEqual(run("controller_manager", "lst")[0], 1)

    def test_3_what_runs_is_not_loaded_started_or_unloaded(self):
        self.assertFalse(load(REAR) or unload(REAR) or switch([REAR]))
        self.assertTrue(switch([REAR], strictness=BEST_EFFORT))
        self.assertFalse(switch([REAR], [REAR], BEST_EFFORT))
        self.assertEqual(controller_states()[REAR], "running")

    def test_4_one_joint_has_one_controller(self):
        rospy.set_param(f"/racecar/{SECOND}", {
            "type": "effort_controllers/JointEffortController", "joint": "left_rear_axle"})
        self.addCleanup(rospy.delete_param, f"/racecar/{SECOND}")
        code, said, reason = run("controller_manager", "spawn", SECOND)
        self.assertEqual((code, said), (0, f"Loaded '{SECOND}'\n"
                                        f"Error when starting ['{SECOND}'] and stopping []\n"))
        self.assertIn(f"left_rear_axle is claimed by {REAR}", reason)
        self.assertFalse(switch([SECOND], strictness=BEST_EFFORT))
        self.assertTrue(switch([SECOND], [REAR]))
        states = controller_states()
        self.assertEqual((states[SECOND], states[REAR]), ("running", "stopped"))
        self.assertTrue(switch([REAR], [SECOND]))
        self.assertTrue(unload(SECOND))

    def test_5_the_spawners_end_unloads_them(self):
        self.assertEqual(self.spawner.end(), 0)
        self.assertIn(f"Succeeded in unloading {REAR}", self.spawner.said())
        self.assertEqual(manager("list"), "No controllers are loaded in mechanism control\n")
        topics = {name for name, _ in rospy.get_published_topics("/racecar")}
        self.assertNotIn("/racecar/joint_states", topics)
