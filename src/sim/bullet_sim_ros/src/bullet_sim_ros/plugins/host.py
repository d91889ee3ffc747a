"""What a plugin is given: its tags, its model, and ROS topics that are closed together."""

from __future__ import annotations

import logging
from collections.abc import Callable

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from rosgraph.names import is_legal_name

from bullet_sim.description import PluginDescription, SensorDescription
from bullet_sim.model import Link, Model
from bullet_sim.rendering.renderer import Renderer
from bullet_sim.world import World
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.plugins.parameters import PluginError, PluginParameters

log = logging.getLogger("bullet_sim.plugins")


class Shared:
    """What all plugins of one simulation use together."""

    def __init__(self, world: World, mailbox: Mailbox, renderer: Callable[[], Renderer]):
        self.world = world
        self.mailbox = mailbox
        self.renderer = renderer  # opened by the first camera
        self._broadcaster: tf2_ros.TransformBroadcaster | None = None

    def send_transforms(self, transforms: list[TransformStamped]) -> None:
        """Publish on /tf."""
        if self._broadcaster is None:
            self._broadcaster = tf2_ros.TransformBroadcaster()
        self._broadcaster.sendTransform(transforms)


class Host:
    """One plugin's view of the simulation. Made and used in the loop's thread."""

    def __init__(self, shared: Shared, model: Model, description: PluginDescription,
                 sensor: SensorDescription | None = None, link: Link | None = None):
        self.shared = shared
        self.world = shared.world
        self.model = model
        self.description = description
        self.parameters = PluginParameters(model.name, description)
        self._sensor = sensor
        self._link = link
        self._closers: list[Callable[[], None]] = []

    @property
    def sensor(self) -> SensorDescription:
        """The sensor that the plugin is in."""
        if self._sensor is None:
            raise PluginError("it belongs inside a <sensor>, not in the model")
        return self._sensor

    @property
    def link(self) -> Link:
        """The link that the sensor is on."""
        if self._link is None:
            raise PluginError("it belongs inside a <sensor>, not in the model")
        return self._link

    def describe(self) -> str:
        """Model, sensor and plugin, for log lines."""
        sensor = f" sensor {self._sensor.name}:" if self._sensor else ""
        name = self.description.name or "(no name)"
        return f"model {self.model.name}:{sensor} plugin {name} ({self.description.filename})"

    def advertise(self, topic: str, kind: type, **options) -> rospy.Publisher:
        """A publisher that lives as long as the plugin."""
        publisher = rospy.Publisher(_legal(topic), kind, **options)
        self._closers.append(publisher.unregister)
        return publisher

    def subscribe(self, topic: str, kind: type, take: Callable, **options) -> rospy.Subscriber:
        """A subscriber; `take(message)` returns what the loop is to do, or None."""
        def leave(message) -> None:
            function = take(message)
            if function is not None:
                self.shared.mailbox.leave(function)

        subscriber = rospy.Subscriber(_legal(topic), kind, leave, **options)
        self._closers.append(subscriber.unregister)
        return subscriber

    def serve(self, name: str, kind: type, handler: Callable) -> None:
        """A service; a name that is taken is a warning, as upstream has it."""
        try:
            service = rospy.Service(_legal(name), kind, handler)
        except rospy.ServiceException as error:
            log.warning("%s: service %s is not offered: %s", self.describe(), name, error)
            return
        self._closers.append(lambda: service.shutdown("the model was deleted"))

    def close(self) -> None:
        """End all topics and services of the plugin."""
        while self._closers:
            self._closers.pop()()


def _legal(name: str) -> str:
    if not is_legal_name(name):
        raise PluginError(f"{name!r} is no legal topic name: letters, digits, _ and / only")
    return name
