"""Shared by the navigation nodes, which are thin layers over nav_algorithms, which needs no ROS."""
