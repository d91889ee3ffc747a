"""bullet_sim: Gazebo's models and worlds on PyBullet, cameras without a GPU. Knows no ROS."""
