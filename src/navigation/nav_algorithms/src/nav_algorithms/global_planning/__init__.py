"""Paths from the robot to a goal, over a whole costmap."""
