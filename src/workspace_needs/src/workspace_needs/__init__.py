"""What a catkin workspace asks for, and where it comes from: ours, Debian, or nobody."""
