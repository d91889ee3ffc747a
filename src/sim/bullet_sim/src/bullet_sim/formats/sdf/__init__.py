"""Reading SDF, all versions that Gazebo 11 reads."""
