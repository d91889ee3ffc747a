"""What dragging the marker means, without ROS."""
