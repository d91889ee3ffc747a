"""Reading URDF by Gazebo's rules."""
