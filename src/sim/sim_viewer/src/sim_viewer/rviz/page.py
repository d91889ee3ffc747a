"""What the page's RViz tab requests first: types of displays, the configuration, frames."""

from typing import Any

from sim_viewer.registry import Context, Refused, argument, operation, watchable
from sim_viewer.rviz.config import ConfigError, beginning, read_config
from sim_viewer.rviz.display_type import ERROR, OK, WARNING
from sim_viewer.rviz.types import TYPES
from sim_viewer.tools.paced import Paced
from sim_viewer.transforms import NoPose, Transforms


@operation("rviz_types")
async def rviz_types(context: Context) -> list[dict[str, Any]]:
    """All types of displays, with their options."""
    return [kind.as_json() for kind in TYPES.values()]


@operation("rviz_config")
async def rviz_config(context: Context) -> dict[str, Any]:
    """The file that the page was started with, read anew by config.py; else a few displays.

    Refused if it cannot be read any more.
    """
    path = context.node.options.rviz
    try:
        return await context.run_in_thread(read_config, path) if path else beginning()
    except ConfigError as error:
        raise Refused(str(error)) from None


@watchable("rviz_place")
class Place(Paced):
    """Arguments: `frame`, the fixed frame, and `target`, another one. Sends the target's x, y, z in
    m in the fixed frame, when it has moved."""

    PERIOD = 0.1

    def __init__(self, context: Context, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._frames = argument(args, "frame", str), argument(args, "target", str)
        self._transforms: Transforms = context.node.shared(Transforms)

    def open(self) -> None:
        self.closing.enter_context(self._transforms.held())

    def collect(self) -> Any:
        try:
            return self.changed(self._transforms.pose(*self._frames).position)
        except NoPose:
            return None


@watchable("rviz_frames")
class Frames(Paced):
    """Argument: `frame`, the fixed frame. Sends `{"frames": {frame: parent}, "status": [level,
    text]}`, the status being that of the fixed frame, on changes."""

    PERIOD = 0.5

    def __init__(self, context: Context, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._fixed = argument(args, "frame", str).lstrip("/")
        self._transforms: Transforms = context.node.shared(Transforms)

    def open(self) -> None:
        self.closing.enter_context(self._transforms.held())

    def collect(self) -> Any:
        frames = self._transforms.frames()
        if self._fixed in frames:
            status = (OK, "OK")
        elif not frames:
            status = (WARNING, "No tf data.  Actual error: "
                               f"Fixed Frame [{self._fixed}] does not exist")
        else:
            status = (ERROR, f"Fixed Frame [{self._fixed}] does not exist")
        return self.changed({"frames": dict(sorted(frames.items())), "status": status})
