"""The pond in which turtles swim and draw: upstream turtlesim's rules, without ROS or a screen."""
