"""Upstream's tools around ros_control's controller manager, over its services."""
