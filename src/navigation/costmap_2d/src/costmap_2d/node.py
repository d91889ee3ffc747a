"""The node costmap_2d: one costmap."""

from __future__ import annotations

import rospy

from costmap_2d.costmap_ros import CostmapROS
from costmap_2d.settings import SEARCHED_UPWARDS
from nav_nodes.ignored import below, warn_of_ignored
from nav_nodes.missing_data import MissingData, watch_clock
from nav_nodes.parameters import ParameterError
from nav_nodes.program import init_node, spin
from nav_nodes.transforms import Transforms


def main() -> int:
    """Runs `~costmap` until shutdown; returns the exit status."""
    init_node("costmap_node")
    missing_data = MissingData()
    watch_clock(missing_data)
    try:
        costmap = CostmapROS("costmap", Transforms(missing_data), missing_data)
    except ParameterError as error:
        rospy.logfatal("%s", error)
        return 1
    warn_of_ignored(below("costmap", costmap.tables), SEARCHED_UPWARDS)
    spin()
    return 0
