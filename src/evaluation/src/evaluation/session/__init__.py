"""What every run stands on: processes, a ROS master, looking on, the progress line, the film."""
