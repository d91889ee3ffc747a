"""What every watched run stands on: processes, a ROS master, the simulator, true poses."""
