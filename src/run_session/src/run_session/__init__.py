"""What every supervised run needs: processes, a ROS master, the simulator, true poses."""
