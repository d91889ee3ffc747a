"""A Kobuki base's events: a bumper is pressed, the floor ends, a wheel drops."""

import math

from kobuki_msgs.msg import BumperEvent, CliffEvent, WheelDropEvent

from bullet_sim.description import SensorDescription
from bullet_sim.drives.kobuki import SECTORS, Kobuki, WheelDrop, pressed_bumpers
from bullet_sim.link import Link
from bullet_sim.sensors.laser import Laser
from bullet_sim_ros import names
from bullet_sim_ros.plugin_host import PluginContext

CONVERTER_SCALE, CONVERTER_GAP = 76123.0, 0.995  # Kobuki's sensor: its reading for a distance in m


class BaseTopic:
    """A topic of the base; those of events have `look`, which publishes changes since last time."""

    def __init__(self, context: PluginContext, base: str, name: str, kind: type):
        self._context = context
        self._topic = context.advertise(names.join(base, name), kind, queue_size=1)

    def wanted(self) -> int:
        """Whether anybody listens: contacts and rays cost time."""
        return self._topic.get_num_connections()


class BumperTopic(BaseTopic):
    """An event for each of the three bumpers that has changed."""

    def __init__(self, context: PluginContext, base: str, link: Link):
        super().__init__(context, base, "events/bumper", BumperEvent)
        self._link = link
        self._pressed: set[str] = set()

    def pressed(self) -> set[str]:
        """Those of `SECTORS` that are pressed."""
        return pressed_bumpers(self._context.world.contacts(), self._link.scoped_name,
                               self._context.model.pose)

    def look(self) -> None:
        """After a step."""
        pressed = self.pressed()
        for name in SECTORS:
            if (name in pressed) != (name in self._pressed):
                state = BumperEvent.PRESSED if name in pressed else BumperEvent.RELEASED
                self._topic.publish(BumperEvent(bumper=getattr(BumperEvent, name.upper()),
                                                state=state))
        self._pressed = pressed


class WheelDropTopic(BaseTopic):
    """An event for each of the two wheels that lost contact with the floor or regained it."""

    def __init__(self, context: PluginContext, base: str, kobuki: Kobuki):
        super().__init__(context, base, "events/wheel_drop", WheelDropEvent)
        model = context.model
        self._drop = WheelDrop({
            side: f"{model.name}::{joint.description.child}"
            for side, joint in zip(("left", "right"), kobuki.wheels, strict=True)},
            context.world.time)
        self._dropped: set[str] = set()

    def dropped(self) -> set[str]:
        """Those of `left` and `right` that have dropped."""
        world = self._context.world
        return self._drop.dropped(world.contacts(), world.time)

    def look(self) -> None:
        """After a step."""
        dropped = self.dropped()
        for side in sorted(dropped ^ self._dropped):
            state = WheelDropEvent.DROPPED if side in dropped else WheelDropEvent.RAISED
            self._topic.publish(WheelDropEvent(wheel=getattr(WheelDropEvent, side.upper()),
                                               state=state))
        self._dropped = dropped


class CliffTopic(BaseTopic):
    """An event when the floor under one sensor ends or begins again.

    FormatError if the sensor's rays are impossible.
    """

    def __init__(self, context: PluginContext, base: str, side: str, threshold: float, link: Link,
                 sensor: SensorDescription):
        """`threshold` in m: a floor this far down counts as a cliff."""
        super().__init__(context, base, "events/cliff", CliffEvent)
        self.side = side
        self._threshold = threshold
        self._laser = Laser(context.world, link, sensor)
        self._cliff = False

    def read(self) -> tuple[bool, int]:
        """Whether there is a cliff, and the A/D converter's reading."""
        distance = float(self._laser.sample().ranges[0])
        reading = CONVERTER_SCALE * math.atan2(CONVERTER_GAP, max(distance, 0.0))
        return distance >= self._threshold, int(reading) & 0xFFFF

    def look(self) -> None:
        """After a step."""
        cliff, reading = self.read()
        if cliff == self._cliff:
            return
        self._cliff = cliff
        self._topic.publish(CliffEvent(
            sensor=getattr(CliffEvent, self.side.upper()),
            state=CliffEvent.CLIFF if cliff else CliffEvent.FLOOR, bottom=reading))
