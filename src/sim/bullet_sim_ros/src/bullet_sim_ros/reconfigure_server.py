"""dynamic_reconfigure for values with ranges, without a generated configuration."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import rospy
from dynamic_reconfigure.server import Server

from bullet_sim_ros.plugin_host import PluginContext

log = logging.getLogger("bullet_sim.plugins")

KINDS = {float: "double", bool: "bool", int: "int", str: "str"}


@dataclass(frozen=True)
class Value:
    """A value and its range."""

    now: float | bool
    least: float | bool
    greatest: float | bool
    description: str


class Owner(Protocol):
    """The owner of a server, which ends with it: the context of a plugin or of a controller."""

    def describe(self) -> str:
        """The owner's name in log lines."""

    def on_close(self, action: Callable[[], None]) -> None:
        """Call `action` when the owner ends."""


def offer_values(owner: Owner, namespace: str, values: Mapping[str, Value],
                 change: Callable[[dict[str, float | bool]], None]) -> None:
    """Let values be changed until `owner` ends; a name that is taken is a warning."""
    try:
        server = ValueServer(namespace, values, change)
    except rospy.ServiceException as error:
        log.warning("%s: dynamic_reconfigure is not offered: %s", owner.describe(), error)
        return
    owner.on_close(server.close)


def offer_changes(context: PluginContext, namespace: str, values: Mapping[str, Value],
                  change: Callable[[dict[str, float | bool]], None]) -> None:
    """As `offer_values`; `change(values)` is called in the loop, and not with the first values."""
    begun: list[bool] = []

    def changed(new: dict[str, float | bool]) -> None:
        """Called in a ROS thread; the first time at once."""
        if begun:
            context.host.mailbox.post(lambda: change(new))
        begun.append(True)

    offer_values(context, namespace, values, changed)


class ValueServer(Server):
    """Calls `change(values)` at once, and in a ROS thread whenever somebody changes one."""

    def __init__(self, namespace: str, values: Mapping[str, Value],
                 change: Callable[[dict[str, float | bool]], None]):
        def changed(config, _level):
            change({name: config[name] for name in values})
            return config

        try:
            super().__init__(_Type(values), changed, namespace)
        except rospy.ServiceException:
            self._close_topics()
            raise

    def _copy_from_parameter_server(self) -> None:
        """Not done: parameters were read already, and an integer would get another type here."""

    def close(self) -> None:
        """End topics and service."""
        self.set_service.shutdown("what it belongs to has ended")
        self._close_topics()

    def _close_topics(self) -> None:
        self.descr_topic.unregister()
        self.update_topic.unregister()


class _Type:
    """The type description that dynamic_reconfigure's generator would have written."""

    def __init__(self, values: Mapping[str, Value]):
        self.defaults = {name: value.now for name, value in values.items()}
        self.min = {name: value.least for name, value in values.items()}
        self.max = {name: value.greatest for name, value in values.items()}
        self.level = dict.fromkeys(values, 1)
        self.config_description = {
            "name": "Default", "type": "", "state": True, "id": 0, "parent": 0, "groups": [],
            "parameters": [
                {"name": name, "type": KINDS[type(value.now)], "default": value.now,
                 "min": value.least, "max": value.greatest, "level": 1, "edit_method": "",
                 "description": value.description} for name, value in values.items()]}
