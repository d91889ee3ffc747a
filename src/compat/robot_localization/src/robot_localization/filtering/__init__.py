"""Arithmetic of the filter: arrays in, arrays out, no ROS."""
