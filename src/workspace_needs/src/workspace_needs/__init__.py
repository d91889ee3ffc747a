"""The dependencies of a catkin workspace, and who provides them: we, Debian, or nobody."""
