"""The ages of a sensor's last message and last usable message."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MessageAge:
    """Ages are s of ROS time; negative: from before the clock was set back.

    `what`: "LaserScan on /scan"; `placed`: age of the newest message that tf can transform to the
    costmap's frame, whether or not an update has used it. `usable`: "LaserScan on /scan that can be
    placed"; `why` it is not; empty if it is, or if the line about tf says so.
    """

    what: str
    usable: str
    heard: float
    placed: float
    why: str = ""
