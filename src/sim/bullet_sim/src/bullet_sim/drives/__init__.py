"""Drives: from a velocity command to joint motors, or to the body itself, and odometry."""
