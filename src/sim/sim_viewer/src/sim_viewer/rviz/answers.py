"""A page's operations on its displays: a frame was drawn, options were changed."""

from sim_viewer.context import Context
from sim_viewer.registry import Refused, operation
from sim_viewer.rviz.display import Display, Displays


def find_display(context: Context, number: int) -> Display:
    """The page's display of this number; Refused if there is none."""
    found = context.node.shared(Displays).get((context.client, number))
    if found is None:
        raise Refused(f"display is {number}, and this page shows no such one")
    return found


@operation("rviz_drawn")
async def rviz_drawn(context: Context, display: int, frame: int) -> None:
    """The page has drawn this frame of a display; Refused if there is no such display."""
    find_display(context, display).drawn(frame)


@operation("rviz_change")
async def rviz_change(context: Context, display: int, options: dict, frame: str) -> None:
    """Set other options or another fixed frame; Refused if they are invalid."""
    find_display(context, display).change(options, frame)
