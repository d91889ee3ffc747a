"""One module per display: messages in, parts of a drawing out. None of them imports ROS."""
