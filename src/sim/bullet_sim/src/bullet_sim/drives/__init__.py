"""Drives: from a velocity command to joint motors, or the body itself, and odometry back."""
