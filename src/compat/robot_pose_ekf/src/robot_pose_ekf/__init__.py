"""Poses of several sensors into one: the node robot_pose_ekf."""
