"""The ROS side of bullet_sim: a node that offers Gazebo's ROS interface."""
