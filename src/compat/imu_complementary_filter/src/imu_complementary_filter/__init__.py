"""The attitude of an IMU: the filter, without ROS."""
