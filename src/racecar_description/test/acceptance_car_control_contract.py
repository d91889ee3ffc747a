#!/usr/bin/env python3
"""What is promised of car_control.launch: start, circles, stops; all with one launch of it."""

import sys
import unittest

import rostest
from acceptance_car import init_node
from acceptance_circle import Circle
from acceptance_start import Start
from acceptance_stops import Stops


class Suite(unittest.TestSuite):
    """The classes in this order, for rostest takes one name; the last one kills nodes."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(Start), load(Circle), load(Stops)])


if __name__ == "__main__":
    init_node("acceptance_car_control")
    rostest.rosrun("racecar_description", "acceptance_car_control",
                   "acceptance_car_control_contract.Suite", sys.argv)
