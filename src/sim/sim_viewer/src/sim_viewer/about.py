"""What the page asks first, and other servers before they start."""

from typing import Any

import rosgraph
import rospy

from sim_viewer.context import Context
from sim_viewer.options import Options
from sim_viewer.registry import operation

PATH = "/about"  # the same over HTTP


def facts(options: Options) -> dict[str, Any]:
    """Which node serves the page for which master, and options that a person may miss."""
    return {"node": rospy.get_name(), "master": rosgraph.get_master_uri(),
            "control": options.control, "rviz": options.rviz, "address": options.address}


@operation("about")
async def about(context: Context) -> dict[str, Any]:
    """Whether this page may change anything, and the name of the node that serves it."""
    return facts(context.node.options)
