#!/usr/bin/env python3
"""The car by bringup's launch file: its controllers' life, steps, emergency stop; its sensors."""

import sys
import unittest

import numpy as np
import rospy
import rostest
from acceptance_car import (
    CONTROLLERS,
    HINGES,
    WHEELS,
    ControllerStates,
    Truth,
    call,
    controller_states,
    init_node,
    results_folder,
    wait_until,
)
from acceptance_picture import Step, write_picture
from acceptance_tools import Spawner, manager, run, slow_down, spawn_all
from controller_manager_msgs.srv import (
    LoadController,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Pose
from racecar_contract import Racecar
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64


class Commands:
    """Publishers of the six command topics."""

    def __init__(self):
        self._publishers = {
            name: rospy.Publisher(f"/racecar/{name}/command", Float64, queue_size=1,
                                  tcp_nodelay=True)
            for name in WHEELS + HINGES}
        wait_until(lambda: all(each.get_num_connections() for each in self._publishers.values()),
                   "six listening controllers")

    def send(self, names, value):
        """rad/s or rad."""
        for name in names:
            self._publishers[name].publish(value)

    def end(self):
        for each in self._publishers.values():
            each.unregister()


PAGE_GAINS = {"rear_wheel": (1.0, 0.0, 0.0), "front_wheel": (0.5, 0.0, 0.0),
              "steering_hinge": (10.0, 0.0, 0.5)}  # p, i, d
RATES, ANGLES = (20.0, 40.0), (0.34, -0.1)  # rad/s, rad
LENGTH = 0.8  # s, of a recorded step
WITHIN = 0.5  # s: by then a wheel has 90 % and a hinge is within 2 %
BEYOND = 0.05  # of the step


class Steps(unittest.TestCase):
    """The page's YAML and gains, unchanged: how wheels and hinges answer a step of a command."""

    @classmethod
    def setUpClass(cls):
        cls.spawner = spawn_all()
        cls.truth, cls.states, cls.commands = Truth(), ControllerStates(), Commands()
        cls.steps = []

    @classmethod
    def tearDownClass(cls):
        cls.commands.end()
        cls.spawner.end()
        write_picture(cls.steps, results_folder(sys.argv) / "step_responses.png")

    def stand(self):
        self.commands.send(WHEELS, 0.0)
        self.commands.send(HINGES, 0.0)
        self.truth.time_until_standing(self.truth.now.time)

    def answers(self, names, value, title):
        """Give the step; each controller's times (s) and values in parts of the command."""
        seen = {name: len(self.states.history[name]) for name in names}
        self.commands.send(names, value)
        found = []
        for name in names:
            history = self.states.history[name]

            def whole(history=history, begin=seen[name]):
                taken = [each.time for each in history[begin:] if each.set_point == value]
                return taken and history[-1].time - taken[0] > LENGTH

            wait_until(whole, f"{LENGTH} s of {name} at {value}")
            # The last state before the command: it came at most 0.01 s before the step itself.
            taken = next(i for i in range(seen[name], len(history))
                         if history[i].set_point == value)
            rows = np.array(history[taken - 1:])
            rows = rows[rows[:, 0] <= rows[0, 0] + LENGTH]
            found.append(Step(title, name, value, rows[:, 0] - rows[0, 0], rows[:, 2]))
        self.steps += found
        return found

    def assert_answer(self, step, share):
        """Within `share` of the command in WITHIN seconds, for good; steady then, never BEYOND."""
        parts = step.values / step.command
        far = step.times[np.abs(parts - 1) > share]
        there = far[-1] if len(far) else 0.0
        rospy.loginfo("%s: %s within %.0f %% after %.2f s, %.2f %% beyond, at last %.4f",
                      step.title, step.name, 100 * share, there,
                      100 * max(parts.max() - 1, 0), parts[-1])
        self.assertLess(there, WITHIN)
        self.assertLess(parts.max(), 1 + BEYOND)
        self.assertLess(np.ptp(parts[step.times > WITHIN]), BEYOND)

    def test_the_gains_are_the_pages(self):
        for name, gains in self.states.gains.items():
            page = next(page for part, page in PAGE_GAINS.items() if part in name)
            self.assertEqual(gains, page, name)

    def test_wheels(self):
        for rate in RATES:
            self.truth.place(0.0, 0.0, 0.0)
            for step in self.answers(WHEELS, rate, f"wheels, {rate:.0f} rad/s"):
                with self.subTest(step=step.title, wheel=step.name):
                    self.assert_answer(step, 0.1)
            self.stand()

    def test_hinges(self):
        for angle in ANGLES:
            for rate in (0.0, RATES[0]):
                self.truth.place(0.0, 0.0, 0.0)
                self.commands.send(WHEELS, rate)
                if rate:
                    self.truth.wait_for_speed(1.0)
                how = "driving at 1 m/s" if rate else "standing"
                for step in self.answers(HINGES, angle, f"hinges, {angle} rad, {how}"):
                    with self.subTest(step=step.title, hinge=step.name):
                        self.assert_answer(step, 0.02)
                self.stand()


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
    """A controller's life by the real tools and the real manager: what works, what is refused."""

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


RATE = 40.0  # rad/s: 2 m/s
TYPE = "<robotSimType>"


class Emergency(unittest.TestCase):
    """The plugin's own emergency stop (<eStopTopic>): no joint gets any effort while it is on."""

    def setUp(self):
        """The car anew, with the tag in its plugin."""
        urdf = rospy.get_param("/robot_description")
        self.addCleanup(rospy.set_param, "/robot_description", urdf)
        with_stop = urdf.replace(TYPE, f"<eStopTopic>stop</eStopTopic>{TYPE}")
        self.assertNotEqual(with_stop, urdf)
        self.assertTrue(call("/gazebo/delete_model", DeleteModel, "racecar").success)
        rospy.set_param("/robot_description", with_stop)
        answer = call("/gazebo/spawn_urdf_model", SpawnModel, "racecar", with_stop, "", Pose(), "")
        self.assertTrue(answer.success, answer.status_message)
        self.addCleanup(spawn_all().end)
        self.truth, self.states, self.commands = Truth(), ControllerStates(), Commands()
        self.addCleanup(self.commands.end)
        self.efforts = []  # s, N m: the greatest of the axles'
        joints = rospy.Subscriber("/racecar/joint_states", JointState, self.take, tcp_nodelay=True)
        self.addCleanup(joints.unregister)

    def take(self, msg):
        axles = [abs(effort) for name, effort in zip(msg.name, msg.effort) if "axle" in name]
        self.efforts.append((msg.header.stamp.to_sec(), max(axles)))

    def test_it_takes_all_effort_and_its_end_gives_it_back(self):
        stop = rospy.Publisher("/racecar/stop", Bool, queue_size=1, tcp_nodelay=True)
        wait_until(stop.get_num_connections, "a listener on the plugin's eStopTopic")
        self.commands.send(WHEELS, RATE)
        self.truth.wait_for_speed(2.0)
        begin = rospy.get_time()
        stop.publish(True)

        def without():
            return [time for time, effort in self.efforts if time > begin and effort == 0]

        wait_until(without, "axles without effort")
        self.commands.send(WHEELS, 2 * RATE)
        self.truth.pass_time(0.5)
        stopped = without()
        rospy.loginfo("the plugin's emergency stop: no effort after %.2f s; it rolls on: %.2f m/s "
                      "0.5 s later", stopped[0] - begin, self.truth.now.speed)
        self.assertLess(stopped[0] - begin, 0.1)
        later = [effort for time, effort in self.efforts if time > stopped[0]]
        self.assertEqual(set(later), {0.0})
        self.assertLess(self.truth.now.speed, 2.02)
        stop.publish(False)  # controllers start anew, with 0 as their command
        self.truth.time_until_standing(rospy.get_time())


class Suite(unittest.TestSuite):
    """The classes in this order, for rostest takes one name."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(Racecar), load(Steps), load(Life), load(Emergency)])


if __name__ == "__main__":
    init_node("acceptance_controllers")
    rostest.rosrun("racecar_description", "acceptance_controllers",
                   "acceptance_controllers_contract.Suite", sys.argv)
