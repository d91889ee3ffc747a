"""Costmaps with upstream's interface: layers, sensors, topics and parameters of costmap_2d."""

from costmap_2d.costmap_ros import CostmapROS

__all__ = ["CostmapROS"]
