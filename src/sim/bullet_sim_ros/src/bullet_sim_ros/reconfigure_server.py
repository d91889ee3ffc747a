"""dynamic_reconfigure for values with ranges, without a generated configuration."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import rospy
from node_basics.reconfigure import Entry, EntryServer

from bullet_sim_ros.inputs import Input
from bullet_sim_ros.plugin_host import PluginContext

log = logging.getLogger("bullet_sim.plugins")


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
            context.host.mailbox.post(lambda: change(new), Input(namespace, None))
        begun.append(True)

    offer_values(context, namespace, values, changed)


class ValueServer(EntryServer):
    """Calls `change(values)` at once, and in a ROS thread after each change."""

    def __init__(self, namespace: str, values: Mapping[str, Value],
                 change: Callable[[dict[str, float | bool]], None]):
        def changed(config, _level):
            change({name: config[name] for name in values})
            return config

        try:
            super().__init__([Entry(name, value.now, value.least, value.greatest,
                                    value.description) for name, value in values.items()],
                             changed, namespace)
        except rospy.ServiceException:
            self._close_topics()
            raise

    def close(self) -> None:
        """End topics and service."""
        self.set_service.shutdown("what it belongs to has ended")
        self._close_topics()

    def _close_topics(self) -> None:
        self.descr_topic.unregister()
        self.update_topic.unregister()
