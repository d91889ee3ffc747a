"""Upstream's gazebo_ros module: `gazebo_interface`, and what the executables are made of."""
