"""What a joystick's events mean, without ROS."""
