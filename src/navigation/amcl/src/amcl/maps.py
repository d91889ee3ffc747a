"""Where the map comes from: a topic, a service, or whoever calls set_map."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import rospy
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import GetMap

from nav_nodes.complaints import Complaints

RETRY = 0.5  # s of wall time between two calls of static_map, as upstream


class MapSource:
    """Gives `take` each map that comes; follows its topic or calls the service until one came."""

    def __init__(self, take: Callable[[OccupancyGridMessage], None],
                 complaints: Complaints) -> None:
        self._take = take
        self._complaints = complaints
        self._topic: rospy.Subscriber | None = None
        self._first_only = False
        self._came = False

    def follow(self, topic: bool, first_only: bool) -> None:
        """From now on the topic, or else the service; with `first_only` one map of the topic."""
        self._first_only = first_only
        if topic and self._topic is None:
            self._topic = rospy.Subscriber("map", OccupancyGridMessage, self._from_topic,
                                           queue_size=1)
        elif not topic and not self._came:
            threading.Thread(target=self._ask, daemon=True).start()
        if not topic and self._topic is not None:
            self._topic.unregister()
            self._topic = None

    def set(self, message: OccupancyGridMessage) -> None:
        """A map from elsewhere."""
        self._came = True
        self._take(message)

    @property
    def missing(self) -> str:
        """What is waited for."""
        if self._topic is not None:
            return f"map on {self._topic.resolved_name}"
        return f"map by the service {rospy.resolve_name('static_map')}"

    def complain(self) -> None:
        """Call now and then: says how long there has been no map."""
        if not self._came:
            self._complaints.missing(self.missing, "start map_server with the map's YAML file")
        else:
            self._complaints.present(self.missing)

    def _from_topic(self, message: OccupancyGridMessage) -> None:
        if not (self._first_only and self._came):
            self.set(message)

    def _ask(self) -> None:
        call = rospy.ServiceProxy("static_map", GetMap)
        while not (rospy.is_shutdown() or self._came):
            try:
                found = call().map
            except (rospy.ServiceException, rospy.ROSException):
                time.sleep(RETRY)
                continue
            if not self._came:
                self.set(found)
