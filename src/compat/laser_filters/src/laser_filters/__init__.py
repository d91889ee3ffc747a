"""Filters of laser scans: the chain and what it can hold, without ROS."""
