"""The markers of one server, from its messages on `.../update_full` and `.../update`.

Each message has a sequence number. Those on the first topic have all markers; each on the second
has changes, with a number that is one larger, or says that there are none. A server sends both
after each change, so a client that has missed changes gets all markers with the next change.
"""

from typing import Any

from sim_viewer.rviz.display_type import ERROR, OK, WARNING, Problem
from sim_viewer.rviz.displays.interactive_marker import InteractiveMarker, unit_pose

UPDATE = 1  # type of an update that has changes
MOST_MARKERS = 500
LONGEST_NAME = 200  # characters
SILENCE = 1.0  # s after which a silent server is reported; servers send twice as often
WAITING = (WARNING, "Waiting for all markers, on update_full")
MISSED = (ERROR, "Update sequence number is out of order.")


class Server:
    """One server's markers: `markers`, by name."""

    def __init__(self) -> None:
        self.markers: dict[str, InteractiveMarker] = {}
        self._number: int | None = None  # of the last change
        self._followed = False  # whether all markers are still to be sent again after that change
        self._missed = False
        self._fresh = True  # whether it has sent anything since the last `status`
        self._heard = 0.0  # s, the last `status` that followed a message

    def begin(self, init: Any) -> bool:
        """Take all markers; returns whether that is news. Problem if some cannot be used."""
        self._fresh = True
        if self._followed and init.seq_num == self._number:
            self._followed = False
            return False
        self._number, self._missed, self._followed = init.seq_num, False, False
        markers: dict[str, InteractiveMarker] = {}
        try:
            _insert(init.markers, markers)
        finally:
            self.markers = markers  # at once, since other threads look for markers meanwhile
        return True

    def update(self, update: Any) -> bool:
        """Take changes; returns whether there are any. Problem if some cannot be used."""
        self._fresh = True
        if self._number is None:
            return False
        ahead = update.seq_num - self._number
        if update.type != UPDATE or ahead != 1:
            self._missed = ahead > 0
            return False
        self._number, self._missed, self._followed = update.seq_num, False, True
        for name in update.erases:
            self.markers.pop(name, None)
        try:
            self._move(update.poses)
        finally:
            _insert(update.markers, self.markers)
        return True

    def status(self, wall: float) -> tuple[str, str]:
        """The status as rviz lists it; `wall` is the present time, s, of a monotonic clock."""
        if self._fresh:
            self._heard, self._fresh = wall, False
        if self._number is None:
            return WAITING
        if self._missed:
            return MISSED
        if wall - self._heard > SILENCE:
            return WARNING, f"No update received for {round(wall - self._heard)} seconds."
        return OK, "OK"

    def _move(self, poses: list[Any]) -> None:
        problem = None
        for one in poses:
            try:
                if one.name in self.markers:
                    self.markers[one.name].move(unit_pose(one.pose), one.header)
            except Problem as found:
                problem = Problem(f"{one.name:.40}: {found}")
        if problem:
            raise problem


def _insert(messages: list[Any], markers: dict[str, InteractiveMarker]) -> None:
    problem = None
    for message in messages:
        if len(message.name) > LONGEST_NAME:
            problem = Problem(f"the name {message.name:.40} is longer than {LONGEST_NAME}")
        elif message.name not in markers and len(markers) >= MOST_MARKERS:
            problem = Problem(f"showing {MOST_MARKERS} markers: more are left out")
        else:
            markers[message.name] = InteractiveMarker(message)
    if problem:
        raise problem
