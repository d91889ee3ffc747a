"""ROS time: simulated while /clock is published, else that of the wall clock."""

import time
from collections import deque

import rospy
from rosgraph_msgs.msg import Clock as ClockMessage

from sim_viewer.subscription import SharedSubscription, Subscription
from sim_viewer.tools import names

FACTOR_WINDOW = 2.0  # s of wall time that the real-time factor is measured over


class SharedClock(SharedSubscription):
    """The time of /clock.

    rospy's own time cannot be used: it chooses between the two when the node starts, and the page
    may have started before the simulator.
    """

    _stamp: rospy.Time | None = None

    def subscribe(self) -> Subscription:
        """Subscribe anew, without a time."""
        self._stamp = None
        return Subscription(names.CLOCK, ClockMessage, self._take)

    @property
    def simulated(self) -> float | None:
        """Simulated time in s; None before the first /clock."""
        return self._stamp.to_sec() if self._stamp is not None else None

    def now(self) -> float:
        """ROS time, s."""
        simulated = self.simulated
        return time.time() if simulated is None else simulated

    def _take(self, message: ClockMessage) -> None:
        self._stamp = message.clock


class FactorMeter:
    """Real-time factor: simulated by wall time over the last seconds."""

    def __init__(self) -> None:
        self._samples: deque[tuple[float, float]] = deque()  # wall s, simulated s

    def add(self, wall: float, simulated: float | None) -> float | None:
        """The factor with this sample; None while there is nothing to compare."""
        if simulated is None or (self._samples and simulated < self._samples[-1][1]):
            self._samples.clear()  # no simulator, or it was reset
        if simulated is None:
            return None
        self._samples.append((wall, simulated))
        while self._samples[0][0] < wall - FACTOR_WINDOW:
            self._samples.popleft()
        (first, before), (last, after) = self._samples[0], self._samples[-1]
        return (after - before) / (last - first) if last - first > 0.4 else None
