"""`rosrun bullet_sim_ros check`: says which parts of a robot, world or package will work."""
