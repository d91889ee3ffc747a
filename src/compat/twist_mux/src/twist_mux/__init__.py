"""Which of several commands counts, without ROS."""
