#!/usr/bin/env python3
"""The car by bringup's launch file: its sensors, its controllers' life, steps, emergency stop."""

import sys
import unittest

import rostest
from acceptance_car import init_node
from acceptance_emergency import Emergency
from acceptance_life import Life
from acceptance_steps import Steps
from racecar_contract import Racecar


class Suite(unittest.TestSuite):
    """The classes in this order, for rostest takes one name."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(Racecar), load(Steps), load(Life), load(Emergency)])


if __name__ == "__main__":
    init_node("acceptance_controllers")
    rostest.rosrun("racecar_description", "acceptance_controllers",
                   "acceptance_controllers_contract.Suite", sys.argv)
