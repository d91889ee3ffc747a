"""The operation that the page calls first."""

import rospy

from sim_viewer.context import Context
from sim_viewer.registry import operation


@operation("about")
async def about(context: Context) -> dict:
    """Whether this page may change anything, and the name of the node that serves it."""
    return {"control": context.control, "node": rospy.get_name()}
