"""The list of topics, their messages as text, and their rates."""

import abc
import time
from collections import deque
from itertools import pairwise
from typing import Any

import rospy

from sim_viewer.registry import argument, watchable
from sim_viewer.subscription import decode
from sim_viewer.tools.master import SystemState
from sim_viewer.tools.messages import MOST_ELEMENTS, to_text
from sim_viewer.tools.paced import Paced

RATE_WINDOW = 5.0  # s of wall time that a rate is measured over
MOST_ELEMENTS_ASKED = 5_000


@watchable("topics")
class Topics(Paced):
    """Sends `[{name, type, publishers, subscribers}]` when it has changed; asks only the master."""

    PERIOD = 2.0

    def collect(self) -> Any:
        return self.changed(rows(self.master.state(), self.master.types()))


def rows(state: SystemState, types: dict[str, str]) -> list[dict[str, Any]]:
    """One row per topic, by name."""
    return [{"name": name, "type": types.get(name, "*"),
             "publishers": state.publishers.get(name, []),
             "subscribers": state.subscribers.get(name, [])}
            for name in sorted({*state.publishers, *state.subscribers})]


class OneTopic(Paced):
    """Subscribes to the argument `topic` while it is watched."""

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self.topic = argument(args, "topic", str)
        self.kind: type | None = None

    @abc.abstractmethod
    def take(self, message: Any) -> None:
        """Called by rospy's threads for each raw message: few of them need to be decoded."""

    def open(self) -> None:
        self.kind = self.master.message_class(self.topic)
        self.subscriber = rospy.Subscriber(self.topic, rospy.AnyMsg, self.take, tcp_nodelay=True)
        self.closing.callback(self.subscriber.unregister)


@watchable("echo")
class Echo(OneTopic):
    """Sends `{"text", "count", "publisher"}` of the newest message, at most five times a second."""

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._elements = min(MOST_ELEMENTS_ASKED,
                             max(1, argument(args, "elements", int, MOST_ELEMENTS)))
        self._newest: Any = None
        self._count = 0

    def take(self, message: Any) -> None:
        self._count += 1
        self._newest = message

    def collect(self) -> Any:
        message, self._newest = self._newest, None
        if message is None:
            return None
        return {"text": to_text(decode(message, self.kind), self._elements), "count": self._count,
                "publisher": (message._connection_header or {}).get("callerid", "")}


@watchable("rate")
class Rate(OneTopic):
    """Sends `{"rate": 1/s, "bandwidth": byte/s, "shortest", "longest": s, "count"}` once a second.

    Wall time, as `rostopic hz --wall-time`. Rates are 0 when nothing comes.
    """

    PERIOD = 1.0

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self.meter = RateMeter()
        self._bytes: deque[tuple[float, int]] = deque()

    def take(self, message: Any) -> None:
        self.meter.add(time.monotonic())

    def collect(self) -> Any:
        now = time.monotonic()
        return {**self.meter.read(now), "bandwidth": self._bandwidth(now)}

    def _bandwidth(self, now: float) -> float:
        connections = self.subscriber.impl.get_stats()[1]
        self._bytes.append((now, sum(received for _, received, *_ in connections)))
        while self._bytes[0][0] < now - RATE_WINDOW:
            self._bytes.popleft()
        (first, before), (last, after) = self._bytes[0], self._bytes[-1]
        return max(0, after - before) / (last - first) if last > first else 0.0


class RateMeter:
    """Rate and gaps of arrivals in the last seconds; `add` may come from another thread."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=10_000)
        self._count = 0

    def add(self, now: float) -> None:
        self._count += 1
        self._times.append(now)

    def read(self, now: float) -> dict[str, float]:
        """`rate` in 1/s, `shortest` and `longest` gap in s, `count` since the beginning."""
        recent = [moment for moment in list(self._times) if moment > now - RATE_WINDOW]
        gaps = [later - earlier for earlier, later in pairwise(recent)]
        span = recent[-1] - recent[0] if recent else 0.0
        # A topic that has been silent for longer than its longest gap has become slower.
        silence = now - recent[-1] if recent else 0.0
        if gaps and silence > 2 * max(gaps):
            span += silence
        return {"rate": len(gaps) / span if span > 0 else 0.0, "shortest": min(gaps, default=0.0),
                "longest": max(gaps, default=0.0), "count": self._count}
