"""rviz/InteractiveMarkers: markers with handles, which a page with control can drag and click.

The first part lists markers and controls; each of the others belongs to a control and is in its
frame. The page places those parts: they follow the mouse, or face the viewer.

A server's messages on `.../update_full` have all of its markers; each on `.../update` has changes,
with a sequence number that is one larger, or says that there are none. A server sends both after
each change, so a client that has missed changes gets all markers with the next change.
"""

from collections import deque
from itertools import islice
from typing import Any

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import ERROR, OK, WARNING, DisplayType, Drawer, Problem, View
from sim_viewer.rviz.displays.interactive_marker import Control, InteractiveMarker, unit_pose
from sim_viewer.rviz.displays.markers import Shown, merged, mesh_parts
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.options import Option

CHANGED = 1  # type of an update that has changes
MOST_MARKERS = 500
LONGEST_NAME = 200  # characters
SILENCE = 1.0  # s after which a silent server is reported; servers send twice as often
WAITING = (WARNING, "Waiting for all markers, on update_full")
MISSED = (ERROR, "Update sequence number is out of order.")
UPDATE = "/update"  # after the markers' namespace
MOST_SERVERS = 20  # on a topic
MOST_CONTROLS = 1000  # that the page draws
MOST_SHAPES = 5000  # of all controls together
MOST_STATUSES = 20
MOST_DRAGS = 100  # that wait for the next drawing
Key = str  # of a marker, for the page: server and name


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
        if update.type != CHANGED or ahead != 1:
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


class Interactive(Drawer):
    """All markers of one namespace."""

    def __init__(self, options: dict[str, Any]):
        super().__init__(options)
        self._servers: dict[str, Server] = {}
        self._crowded = False
        self._drags: deque[tuple[Key, Pose]] = deque(maxlen=MOST_DRAGS)

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        """All markers of a server, or changes. Problem if some cannot be used."""
        self._follow_drags()  # the message may be the server's answer to them
        if len(message.server_id) > LONGEST_NAME:
            raise Problem(f"the server's id {message.server_id:.40} is longer than {LONGEST_NAME}")
        self._crowded = (message.server_id not in self._servers
                         and len(self._servers) >= MOST_SERVERS)
        if self._crowded:
            return
        server = self._servers.setdefault(message.server_id, Server())
        try:
            news = server.update(message) if hasattr(message, "type") else server.begin(message)
        except Exception:  # which the status list shows; some markers may have been taken
            self.changed = True
            raise
        self.changed = self.changed or news

    def find(self, key: Key) -> InteractiveMarker | None:
        """A marker that the page knows. In any thread."""
        server, _, name = key.partition("\n")
        found = self._servers.get(server)
        return found.markers.get(name) if found else None

    def drag(self, key: Key, pose: Pose) -> None:
        """The page has moved a marker to this pose in its header's frame. In any thread."""
        self._drags.append((key, pose))

    def place_anew(self) -> bool:
        """Each marker is placed anew, by its own frame and stamp."""
        for _, one in self._all():
            one.place = None
        self.changed = True
        return True

    def draw(self, view: View) -> list[Part] | None:
        self._follow_drags()
        seen = self._fitting()
        new = [one for _, one in seen if not one.built]
        for one in new:
            one.build(view, view.most_points // len(new))
        moved = [one.put(view) for _, one in seen]
        self.statuses = self._statuses(seen, view)
        if not self.changed and not any(moved):
            return None
        self.changed = False
        placed = [(key, one) for key, one in seen if one.place is not None]
        head = Part("interactive", fields={
            "markers": [one.as_json(key) for key, one in placed],
            "visual_aids": self.options["Show Visual Aids"]})
        return [head, *self._parts(placed, view)] if placed else []

    def _all(self) -> list[tuple[Key, InteractiveMarker]]:
        return [(f"{server}\n{name}", one) for server, known in self._servers.items()
                for name, one in known.markers.items()]

    def _follow_drags(self) -> None:
        while self._drags:
            key, pose = self._drags.popleft()
            if marker := self.find(key):
                marker.move(pose)
                self.changed = True

    def _fitting(self) -> list[tuple[Key, InteractiveMarker]]:
        """The first markers, as many as a page can draw."""
        controls = shapes = 0
        for count, (_, one) in enumerate(found := self._all()):
            controls += len(one.message.controls)
            shapes += one.size
            if controls > MOST_CONTROLS or shapes > MOST_SHAPES:
                return found[:count]
        return found

    def _statuses(self, seen: list[tuple[Key, InteractiveMarker]],
                  view: View) -> dict[str, tuple[str, str]]:
        found = {name: server.status(view.wall) for name, server in self._servers.items()}
        wrong = ((one.message.name, one.lost or one.problems[0]) for _, one in seen
                 if one.lost or one.problems)
        found |= {name: (ERROR, text) for name, text in islice(wrong, MOST_STATUSES)}
        total = sum(len(server.markers) for server in self._servers.values())
        if len(seen) < total:
            found["Markers"] = WARNING, f"showing {len(seen)} of {total} markers"
        if self._crowded:
            found["Servers"] = WARNING, f"showing {MOST_SERVERS}: more are left out"
        return found

    def _parts(self, placed: list[tuple[Key, InteractiveMarker]], view: View) -> list[Part]:
        """The parts of each control, with the numbers of control and marker."""
        owners, parts, meshes = [], [], []
        for number, (_, marker) in enumerate(placed):
            for index, control in enumerate(marker.controls):
                shown = self._shown(control)
                owner = {"marker": number, "control": index}
                for part in merged(shown):
                    part.fields = {**part.fields, **owner}
                    parts.append(part)
                meshes.append({f"{number}/{index}/{at}": one for at, one in enumerate(shown)
                               if one.visuals})
                owners.append(owner)
        for part, group in mesh_parts(meshes, view):
            part.fields |= owners[group]
            parts.append(part)
        return parts

    def _shown(self, control: Control) -> list[Shown]:
        if not self.options.get(control.option, True):
            return []
        return [one for one in control.shown if one.place is not None]


def namespace(topic: str) -> str:
    """The markers' namespace, from the name of their update topic."""
    return topic.removesuffix(UPDATE)


TYPE = DisplayType(
    "rviz/InteractiveMarkers", Interactive, topic="/basic_controls/update",
    topic_key="Update Topic", messages=("visualization_msgs/InteractiveMarkerUpdate",),
    at_stamp=False, every=True,
    beside="visualization_msgs/InteractiveMarkerInit",
    beside_topic=lambda topic: f"{namespace(topic)}/update_full", period=0.1, options=(
        Option("Show Descriptions", "switch", True), Option("Show Axes", "switch", False),
        Option("Show Visual Aids", "switch", False)))
