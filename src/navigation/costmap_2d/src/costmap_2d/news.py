"""How long ago a sensor was heard from, and when what it said was last of use."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class News:
    """Ages are s of ROS time; below 0: of before the clock was set back.

    `what`: "LaserScan on /scan"; `placed`: since the newest message came that tf can place in the
    costmap's frame, whether an update has taken it yet or not. `usable`: "LaserScan on /scan that
    can be placed"; `why` it is not; empty where it is, and where tf's own line says it.
    """

    what: str
    usable: str
    heard: float
    placed: float
    why: str = ""
