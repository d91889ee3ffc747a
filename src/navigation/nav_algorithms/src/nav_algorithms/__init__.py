"""Mapping, localisation, costmaps and planning. No ROS here: arrays in, arrays out."""
