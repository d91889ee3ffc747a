"""What the navigation nodes share; each of them is thin, and nav_algorithms knows no ROS."""
