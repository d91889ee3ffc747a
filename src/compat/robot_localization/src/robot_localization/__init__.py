"""Odometry, IMU and poses into one estimate: the nodes of robot_localization."""
