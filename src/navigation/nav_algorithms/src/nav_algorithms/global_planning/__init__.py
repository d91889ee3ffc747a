"""Paths from where the robot is to where it shall be, through a whole costmap."""
