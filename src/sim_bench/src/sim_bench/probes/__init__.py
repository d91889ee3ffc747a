"""Small ROS nodes that write down what they see, one line each time, for the part that reads it."""
