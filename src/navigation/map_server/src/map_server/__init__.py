"""Maps as files (map_files: no ROS), and the nodes that serve and save them."""
