"""The topic `command` of a controller: one number, or one for each joint."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence

from std_msgs.msg import Float64, Float64MultiArray

from bullet_sim.control.controllers.commands import Commands
from bullet_sim_ros.control.controller_host import ControllerHost
from bullet_sim_ros.convert import LARGEST

log = logging.getLogger("bullet_sim.control")


def command_timeout(host: ControllerHost) -> float:
    """`command_timeout`, s: ours; upstream's controllers go on with the last command for ever."""
    return max(0.0, host.parameters.number("command_timeout", 0.0))


def subscribe_one(host: ControllerHost, commands: Commands) -> None:
    """`command` is a Float64."""
    def take(msg: Float64) -> Callable[[], None] | None:
        return _checked(host, commands, (msg.data,))

    host.subscribe("command", Float64, take, queue_size=1, tcp_nodelay=True)


def subscribe_all(host: ControllerHost, commands: Commands, count: int) -> None:
    """`command` is a Float64MultiArray with a number for each joint."""
    def take(msg: Float64MultiArray) -> Callable[[], None] | None:
        if len(msg.data) != count:
            log.error("%s: Dimension of command (%d) does not match number of joints (%d)! Not "
                      "executing!", host.describe(), len(msg.data), count)
            return None
        return _checked(host, commands, msg.data)

    host.subscribe("command", Float64MultiArray, take, queue_size=1, tcp_nodelay=True)


def _checked(host: ControllerHost, commands: Commands,
             values: Sequence[float]) -> Callable[[], None] | None:
    if all(abs(value) <= LARGEST for value in values):
        return lambda: commands.take(values)
    log.warning("%s: a command that is not finite, or beyond %g, is ignored", host.describe(),
                LARGEST)
    return None
