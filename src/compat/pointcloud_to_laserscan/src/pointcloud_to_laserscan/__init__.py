"""Arithmetic of pointcloud_to_laserscan: arrays in, arrays out, no ROS."""
