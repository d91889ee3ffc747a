"""The topic `command` of a controller: one number, or one for each joint."""

import logging
import time
from collections.abc import Callable, Sequence

from std_msgs.msg import Float64, Float64MultiArray

from bullet_sim.control.controllers.commands import Commands
from bullet_sim.errors import PluginError
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.convert import LARGEST, is_sane

COMPLAINT_PERIOD = 10.0  # s, wall clock: a publisher of bad commands sends many

log = logging.getLogger("bullet_sim.control")


def command_timeout(context: ControllerContext) -> float:
    """`command_timeout`, s, an addition: ros_controllers keep the last command for ever.

    PluginError if it is negative.
    """
    seconds = context.parameters.number("command_timeout", 0.0)
    if seconds < 0:
        raise PluginError(
            f"parameter {context.parameters.where('command_timeout')} is {seconds:g}, "
            "which is not a time-out: write seconds, not negative (0: none)"
        )
    return seconds


class _LimitedLog:
    """Logs the bad commands of one controller: at most one line per COMPLAINT_PERIOD."""

    def __init__(self, context: ControllerContext):
        self._context = context
        self._next = 0.0  # s, wall

    def write(self, level: int, text: str, *values: object) -> None:
        """The limit uses the wall clock: simulated time may be paused, or fast."""
        now = time.monotonic()
        if now >= self._next:
            self._next = now + COMPLAINT_PERIOD
            log.log(level, f"%s: {text}", self._context.describe(), *values)


def subscribe_one(context: ControllerContext, commands: Commands) -> None:
    """Subscribe to `command` as Float64."""
    complaints = _LimitedLog(context)

    def take(msg: Float64) -> Callable[[], None] | None:
        return _checked(complaints, commands, (msg.data,))

    context.subscribe("command", Float64, take, queue_size=1, tcp_nodelay=True)


def subscribe_all(context: ControllerContext, commands: Commands, count: int) -> None:
    """Subscribe to `command` as Float64MultiArray with a number for each of `count` joints."""
    complaints = _LimitedLog(context)

    def take(msg: Float64MultiArray) -> Callable[[], None] | None:
        if len(msg.data) != count:
            complaints.write(logging.ERROR, "Dimension of command (%d) does not match number of "
                           "joints (%d)! Not executing!", len(msg.data), count)
            return None
        return _checked(complaints, commands, msg.data)

    context.subscribe("command", Float64MultiArray, take, queue_size=1, tcp_nodelay=True)


def subscribe(context: ControllerContext, commands: Commands, joints: int, group: bool) -> None:
    """Subscribe to `command` of one joint or, for a group, of `joints` joints."""
    if group:
        subscribe_all(context, commands, joints)
    else:
        subscribe_one(context, commands)


def _checked(complaints: _LimitedLog, commands: Commands,
             values: Sequence[float]) -> Callable[[], None] | None:
    if is_sane(values):
        return lambda: commands.take(values)
    complaints.write(logging.WARNING, "a command that is not finite, or beyond %g, is ignored",
                   LARGEST)
    return None
