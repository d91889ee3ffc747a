"""What a Kobuki base tells when it happens: a bumper is pressed, the floor ends."""

from __future__ import annotations

import math

from kobuki_msgs.msg import BumperEvent, CliffEvent

from bullet_sim.description import SensorDescription
from bullet_sim.drives.bumper import SECTORS, pressed_bumpers
from bullet_sim.link import Link
from bullet_sim.sensors.laser import Laser
from bullet_sim_ros import names
from bullet_sim_ros.plugins.host import Host

CONVERTER_SCALE, CONVERTER_GAP = 76123.0, 0.995  # Kobuki's sensor: its reading for a distance in m


class BumperTopic:
    """`look` tells of each of the three that has changed."""

    def __init__(self, host: Host, base: str, link: Link):
        self._host, self._link = host, link
        self._pressed: set[str] = set()
        self._topic = host.advertise(names.join(base, "events/bumper"), BumperEvent, queue_size=1)

    def wanted(self) -> int:
        """Whether anybody listens: contacts and rays cost time."""
        return self._topic.get_num_connections()

    def look(self) -> None:
        """After a step."""
        pressed = pressed_bumpers(self._host.world.contacts(), self._link.scoped_name,
                                  self._host.model.pose)
        for name in SECTORS:
            if (name in pressed) != (name in self._pressed):
                state = BumperEvent.PRESSED if name in pressed else BumperEvent.RELEASED
                self._topic.publish(BumperEvent(bumper=getattr(BumperEvent, name.upper()),
                                                state=state))
        self._pressed = pressed


class CliffTopic:
    """`look` tells when the floor under one sensor goes away or comes back."""

    def __init__(self, host: Host, base: str, side: str, threshold: float, link: Link,
                 sensor: SensorDescription):
        """`threshold` in m: a floor this far down is none."""
        self._side = getattr(CliffEvent, side.upper())
        self._threshold = threshold
        self._laser = Laser(host.world, link, sensor)
        self._cliff = False
        self._topic = host.advertise(names.join(base, "events/cliff"), CliffEvent, queue_size=1)

    def wanted(self) -> int:
        """Whether anybody listens: contacts and rays cost time."""
        return self._topic.get_num_connections()

    def look(self) -> None:
        """After a step."""
        distance = float(self._laser.sample().ranges[0])
        cliff = distance >= self._threshold
        if cliff == self._cliff:
            return
        self._cliff = cliff
        reading = CONVERTER_SCALE * math.atan2(CONVERTER_GAP, max(distance, 0.0))
        self._topic.publish(CliffEvent(
            sensor=self._side, state=CliffEvent.CLIFF if cliff else CliffEvent.FLOOR,
            bottom=int(reading) & 0xFFFF))
