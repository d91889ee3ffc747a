"""The source of the map: a topic, a service, or a call of set_map."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import rospy
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import GetMap

from nav_algorithms.cells import OccupancyGrid
from nav_nodes.messages import grid_of
from nav_nodes.missing_data import MissingData

RETRY = 0.5  # s of wall time between two calls of static_map, as upstream
ADVICE = "start map_server with the map's YAML file"


def grid_in(message: OccupancyGridMessage, frame: str) -> OccupancyGrid:
    """Its grid; logs a line if its frame is not ours. Raises ValueError."""
    grid = grid_of(message)
    if message.header.frame_id.lstrip("/") != frame.lstrip("/"):
        rospy.logwarn("the map's frame is %r, but ~global_frame_id is %r: what is published "
                      "may not fit it", message.header.frame_id, frame.lstrip("/"))
    rospy.loginfo("Received a %d X %d map @ %.3f m/pix", *grid.cells.shape[::-1], grid.resolution)
    return grid


class MapSource:
    """Passes each map to `take`; follows the topic, or calls the service until a map came.

    A map that `take` rejects by a ValueError does not count.
    """

    def __init__(self, take: Callable[[OccupancyGridMessage], None],
                 missing_data: MissingData) -> None:
        self._take = take
        self._missing_data = missing_data
        self._topic: rospy.Subscriber | None = None
        self._first_only = False
        self._lock = threading.Lock()  # of two simultaneous maps the second must see the first
        self._came = False
        self._advice = ADVICE

    def follow(self, topic: bool, first_only: bool) -> None:
        """Use the topic from now on, else the service; `first_only`: only the topic's first map."""
        self._first_only = first_only
        if topic and self._topic is None:
            self._topic = rospy.Subscriber("map", OccupancyGridMessage, self._from_topic,
                                           queue_size=1)
        elif not topic and not self._came:
            threading.Thread(target=self._ask, daemon=True).start()
        if not topic and self._topic is not None:
            self._topic.unregister()
            self._topic = None

    def set(self, message: OccupancyGridMessage, only_first: bool = False) -> bool:
        """Take a map; False if it is unusable. `only_first`: ignored if there is one already."""
        with self._lock:
            if only_first and self._came:
                return True
            try:
                self._take(message)
            except ValueError as error:
                self._refuse(error)
                return False
            self._came, self._advice = True, ADVICE
            return True

    def _refuse(self, error: ValueError) -> None:
        self._advice = f"the one that came is of no use: {error}"
        if self._came:  # else `complain` reports it
            rospy.logerr_throttle(5.0, "a map came that is of no use, passed over: %s", error)

    @property
    def missing(self) -> str:
        """The topic or service that is waited for, in words."""
        if self._topic is not None:
            return f"map on {self._topic.resolved_name}"
        return f"map by the service {rospy.resolve_name('static_map')}"

    def complain(self) -> None:
        """Call periodically: logs how long there has been no map."""
        if not self._came:
            self._missing_data.missing(self.missing, self._advice)
        else:
            self._missing_data.present(self.missing)

    def _from_topic(self, message: OccupancyGridMessage) -> None:
        self.set(message, self._first_only)

    def _ask(self) -> None:
        call = rospy.ServiceProxy("static_map", GetMap)
        while not (rospy.is_shutdown() or self._came):
            try:
                found = call().map
            except (rospy.ServiceException, rospy.ROSException):
                found = None
            if found is not None and self.set(found, only_first=True):
                return
            time.sleep(RETRY)
