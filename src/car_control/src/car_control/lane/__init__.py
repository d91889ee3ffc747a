"""Follows the yellow line in the middle of a road by camera; no ROS."""
