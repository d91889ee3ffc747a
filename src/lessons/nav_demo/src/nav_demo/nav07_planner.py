"""Lesson 7: a global planner of your own, breadth-first over the cells.  自己写的全局规划器

planner_plugin.xml names the class; move_base calls its two methods like a C++ planner's.
"""

from collections import deque
from copy import deepcopy

INSCRIBED = 253  # at this cost or more the car would touch something; 255: unknown
NEIGHBOURS = [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1)]


class BreadthFirst:
    """The path with the fewest cells."""

    def initialize(self, name, costmap):
        """Called once at the start; `name`: BreadthFirst, for parameters and topics below ~name."""
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
