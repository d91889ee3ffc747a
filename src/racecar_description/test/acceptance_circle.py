"""Circles at constant steering: radii by Ackermann's law, and by the tutorial's to compare."""

import math
import sys
import unittest

import numpy as np
import rospy
import yaml
from acceptance_car import WHEELBASE, Driver, Truth, all_running, results_folder, wait_until
from dynamic_reconfigure.client import Client

SPEED = 1.0  # m/s
PAGE_SPEED = 2.5  # of the tutorial's law: 8 rad/s for each, 1 m/s with this car's wheels
CIRCLES = {0.34: (1.0, 1.5), -0.2: (1.0, 5.5)}  # rad: where it begins, eastwards, m
PART = math.radians(150)  # of a circle that is driven
SETTLING = 0.5  # s


def fitted_radius(samples):
    """Least squares: x^2 + y^2 = 2 a x + 2 b y + c."""
    points = np.array([(each.x, each.y) for each in samples])
    rows = np.column_stack([2 * points, np.ones(len(points))])
    a, b, c = np.linalg.lstsq(rows, (points**2).sum(axis=1), rcond=None)[0]
    return math.sqrt(c + a * a + b * b)


class Circle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        wait_until(all_running, "seven running controllers")
        cls.truth, cls.law = Truth(), Client("/motor_control", timeout=30.0)
        cls.driver, cls.figures = Driver(), []

    @classmethod
    def tearDownClass(cls):
        cls.driver.end()
        path = results_folder(sys.argv) / "circles.yaml"
        path.write_text(yaml.safe_dump(cls.figures, sort_keys=False), encoding="utf-8")

    def driven(self, ackermann, angle):
        """Radius in parts of wheelbase / tan(angle), and mean speed in m/s."""
        truth = self.truth
        self.law.update_configuration({"ackermann": ackermann})
        truth.place(*CIRCLES[angle], 0.0)
        self.driver.drive(SPEED if ackermann else PAGE_SPEED, angle)
        truth.pass_time(SETTLING)
        first, turned = len(truth.samples), 0.0
        while turned < PART:
            before = truth.now
            wait_until(lambda before=before: truth.now.time > before.time, "the next sample")
            turned += abs(math.remainder(truth.now.yaw - before.yaw, math.tau))
        samples = truth.samples[first:]
        self.driver.drive(0.0, angle)
        truth.time_until_standing(truth.now.time)
        radius, wanted = fitted_radius(samples), WHEELBASE / math.tan(abs(angle))
        speed = float(np.mean([each.speed for each in samples]))
        self.figures.append({
            "law": "ackermann" if ackermann else "tutorial", "angle_rad": angle,
            "radius_m": round(radius, 4), "wheelbase_over_tan_m": round(wanted, 4),
            "speed_mps": round(speed, 4)})
        rospy.loginfo("circle: %s", self.figures[-1])
        return radius / wanted, speed

    def test_ackermann(self):
        for angle in CIRCLES:
            with self.subTest(angle=angle):
                ratio, speed = self.driven(True, angle)
                self.assertAlmostEqual(ratio, 1.0, delta=0.03)
                self.assertAlmostEqual(speed, SPEED, delta=0.01)

    def test_the_tutorials_law_is_recorded(self):
        self.addCleanup(self.law.update_configuration, {"ackermann": True})
        self.driven(False, max(CIRCLES))
