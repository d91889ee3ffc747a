"""The page's YAML and gains, unchanged: how wheels and hinges answer a step of their command."""

import sys
import unittest

import numpy as np
import rospy
from acceptance_car import HINGES, WHEELS, ControllerStates, Truth, results_folder, wait_until
from acceptance_commands import Commands
from acceptance_picture import Step, write_picture
from acceptance_tools import spawn_all

PAGE_GAINS = {"rear_wheel": (1.0, 0.0, 0.0), "front_wheel": (0.5, 0.0, 0.0),
              "steering_hinge": (10.0, 0.0, 0.5)}  # p, i, d
RATES, ANGLES = (20.0, 40.0), (0.34, -0.1)  # rad/s, rad
LENGTH = 0.8  # s, of a recorded step
WITHIN = 0.5  # s: by then a wheel has 90 % and a hinge is within 2 %
BEYOND = 0.05  # of the step


class Steps(unittest.TestCase):
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
