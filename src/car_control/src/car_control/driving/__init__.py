"""Driving mathematics on plain numbers and NumPy arrays: no ROS, no files, no images."""
