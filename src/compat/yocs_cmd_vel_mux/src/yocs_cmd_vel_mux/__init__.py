"""Who holds the robot, without ROS."""
