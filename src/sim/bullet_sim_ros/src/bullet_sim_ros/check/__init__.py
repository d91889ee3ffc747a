"""`rosrun bullet_sim_ros check`: what of a robot, world or package will work, before it runs."""
