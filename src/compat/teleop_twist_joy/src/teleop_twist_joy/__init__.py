"""What teleop_twist_joy makes of a joystick, without ROS."""
