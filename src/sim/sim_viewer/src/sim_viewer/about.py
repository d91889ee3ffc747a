"""What the page asks first."""

import rospy

from sim_viewer.context import Context
from sim_viewer.registry import operation


@operation("about")
async def about(context: Context) -> dict:
    """Whether this page may change anything, and who serves it."""
    return {"control": context.control, "node": rospy.get_name()}
