"""ros_control's side of the joints: controllers by type, the manager, and its services."""
