"""Subscriptions that do not disturb each other, and messages read without unpacking their arrays.

rospy keeps one connection per topic and process, and all its subscribers get messages of the class
that the first of them named. So all subscribers of this node ask for raw messages.
"""

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import rospy


def decode(message: Any, kind: type) -> Any:
    """A raw message as one of class `kind`; long arrays of numbers stay numpy views of it.

    Python lists of a map with 16 million cells would block everything else for half a second.
    """
    if not isinstance(message, rospy.AnyMsg):
        return message  # of rospy's own subscription to /clock
    read = kind().deserialize_numpy(message._buff, np)
    read._connection_header = message._connection_header
    return read


class Subscription(rospy.Subscriber):
    """`take(message, *args)` is called in rospy's threads, with messages of class `kind`."""

    def __init__(self, topic: str, kind: type, take: Callable[..., None], *args: Any):
        self._kind, self._take_read, self._args = kind, take, args
        super().__init__(topic, rospy.AnyMsg, self._take, tcp_nodelay=True)

    def _take(self, raw: Any) -> None:
        try:
            message = decode(raw, self._kind)
        except Exception as error:  # a publisher with another definition of the type
            rospy.logwarn_throttle(10, f"{self.name}: no {self._kind._type}: {error}")
            return
        self._take_read(message, *self._args)


class SharedSubscription(ABC):
    """One subscription for all who hold it, which ends with the last of them. Thread safe."""

    def __init__(self, _node: Any = None):
        self._lock = threading.Lock()
        self._holders = 0

    @contextmanager
    def held(self) -> Iterator[None]:
        """Subscribed while the context is entered."""
        with self._lock:
            self._holders += 1
            if self._holders == 1:
                self._subscriber = self.subscribe()
        try:
            yield
        finally:
            with self._lock:
                self._holders -= 1
                if not self._holders:
                    self._subscriber.unregister()

    @abstractmethod
    def subscribe(self) -> Subscription:
        """Make a new subscription."""
