#!/usr/bin/env python3
"""Exercise cost_planner: the cheapest path, not the shortest.  练习：代价最小的路，而不是最短的路。

nav07_planner.py with costs. To try it in the lesson, copy it over src/nav_demo/nav07_planner.py
and rename the class to BreadthFirst.
"""

from collections import deque
from copy import deepcopy

INSCRIBED = 253  # at this cost or more the car would touch something; 255: unknown
NEIGHBOURS = [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1)]


class Planner:
    """Yours: the least sum of costs, not of cells.  请修改：代价之和最小，而不是格数"""

    def initialize(self, name, costmap):
        """Called once, at the start; `name`: the class's, for parameters and topics below ~name."""
        self.costmap = costmap

    def make_plan(self, start, goal):
        """List of PoseStamped from start to goal; empty if there is no path."""
        grid = self.costmap.snapshot()  # cells (rows, columns), resolution (m), origin (x, y)
        first, last = cell_of(grid, start.pose.position), cell_of(grid, goal.pose.position)
        came_from, waiting = {first: None}, deque([first])
        while waiting and last not in came_from:
            cell = waiting.popleft()
            for row, column in NEIGHBOURS:
                near = (cell[0] + row, cell[1] + column)
                if near not in came_from and is_free(grid, near):
                    came_from[near] = cell
                    waiting.append(near)
        if last not in came_from:
            return []
        cells = [last]
        while came_from[cells[-1]] is not None:
            cells.append(came_from[cells[-1]])
        between = [pose_at(grid, cell, start) for cell in reversed(cells[1:-1])]
        return [start, *between, goal]


def cell_of(grid, point):
    """(row, column) of the cell at a point in m."""
    x, y = grid.origin
    return int((point.y - y) // grid.resolution), int((point.x - x) // grid.resolution)


def is_free(grid, cell):
    """Whether the car's centre may be in this cell."""
    rows, columns = grid.cells.shape
    return (0 <= cell[0] < rows and 0 <= cell[1] < columns) and grid.cells[cell] < INSCRIBED


def pose_at(grid, cell, like):
    """The pose `like`, moved to the cell's centre."""
    pose = deepcopy(like)
    pose.pose.position.x = grid.origin[0] + (cell[1] + 0.5) * grid.resolution
    pose.pose.position.y = grid.origin[1] + (cell[0] + 0.5) * grid.resolution
    return pose
