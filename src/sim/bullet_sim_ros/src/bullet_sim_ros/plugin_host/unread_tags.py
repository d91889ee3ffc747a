"""The warning about a plugin's tags that nothing reads, as flatland's EnsureAccessedAllKeys."""

import functools
import logging
from pathlib import PurePosixPath

from bullet_sim.errors import did_you_mean
from bullet_sim_ros.interface import Row, read_interface, rows_by_name
from bullet_sim_ros.plugin_host.context import PluginContext

log = logging.getLogger("bullet_sim.plugins.tags")

# Robots carry these in plugins of any kind, whether or not the plugin reads them.
EVERY_PLUGIN = frozenset(("robotNamespace", "alwaysOn", "always_on", "updateRate", "update_rate",
                          "visualize", "plugin"))


def warn_of_unread_tags(context: PluginContext) -> None:
    """One warning for each tag that the plugin has not read and the interface table has not.

    Tags of the table that have no effect, or are read later, are no warning.
    """
    unread = [tag for tag in context.parameters.unread() if tag not in EVERY_PLUGIN]
    if not unread:
        return
    row = _documented().get(PurePosixPath(context.description.filename).name)
    known = set(row.tags) if row else set()
    for tag in unread:
        if tag not in known:
            names = sorted(map(_inner, known | context.parameters.read))
            log.warning("%s: <%s> is ignored, as by Gazebo: the plugin has no such tag%s",
                        context.describe(), _inner(tag),
                        did_you_mean(_inner(tag), names, 0.75, "<{}>"))


def _inner(path: str) -> str:
    """`a><b` of `a/b`."""
    return path.replace("/", "><")


@functools.cache
def _documented() -> dict[str, Row]:
    return rows_by_name(read_interface())
