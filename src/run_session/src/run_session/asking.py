"""Calls one service of the simulator repeatedly, at a given rate."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import rospy
from std_srvs.srv import Empty


class Asker:
    """Keeps the connection open and reconnects when it breaks; stops when `ended` is set."""

    def __init__(self, ended: threading.Event):
        self._ended = ended
        self._service, self._kind, self._proxy = "", Empty, None

    def ticks(self, rate_hz: float, service: str = "", kind: type = Empty) -> Iterator[None]:
        """Yields at this rate (wall time), each time the service is to be called."""
        self._service, self._kind, self._proxy = service, kind, None
        while not self._ended.is_set():
            began = time.monotonic()
            yield
            self._ended.wait(max(0.0, began + 1.0 / rate_hz - time.monotonic()))

    def call(self, *arguments: str) -> object | None:
        """The service's response; None if the call failed."""
        try:
            if self._proxy is None:
                self._proxy = rospy.ServiceProxy(self._service, self._kind, persistent=True)
            return self._proxy(*arguments)
        except (rospy.ServiceException, rospy.ROSException, OSError):
            self._proxy = None
            return None
