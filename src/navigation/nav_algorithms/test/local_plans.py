"""A robot, a free window round it, and a plan straight ahead, for tests of local planners."""

import numpy as np

from nav_algorithms.costmap.costs import Costmap

WAFFLE = np.array([[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]])
ORIGIN, STILL = np.zeros(3), np.zeros(3)


def window_around(cells=60):
    return Costmap(np.zeros((cells, cells), np.uint8), 0.05, (-cells / 40, -cells / 40))


def straight(length=1.2, yaw=0.0, count=40):
    along = np.linspace(0.0, length, count)
    return np.column_stack((along * np.cos(yaw), along * np.sin(yaw), np.full(count, yaw)))
