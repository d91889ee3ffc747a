"""Drive trains: from a velocity command to joint motors, and odometry back."""
