"""Following the yellow line in the middle of a road by camera; knows no ROS."""
