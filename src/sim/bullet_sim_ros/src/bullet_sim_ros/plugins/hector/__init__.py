"""The plugins of hector_gazebo_plugins."""
