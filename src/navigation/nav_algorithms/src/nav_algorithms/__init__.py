"""Mapping, localisation, costmaps and planning. No ROS in here: arrays in, arrays out."""
