"""The ROS side of bullet_sim: one node that answers where Gazebo would."""
