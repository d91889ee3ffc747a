"""Arithmetic of depthimage_to_laserscan: arrays in, arrays out, no ROS."""
