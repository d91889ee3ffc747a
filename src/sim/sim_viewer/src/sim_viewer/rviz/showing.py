"""One display at work: messages in, parts and statuses out. Without ROS and threads of its own."""

import time
from collections import deque
from collections.abc import Callable
from typing import Any

from bullet_sim.errors import SimulationError
from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import (
    ERROR,
    OK,
    WARNING,
    DisplayType,
    NoTransform,
    Problem,
    Statuses,
    View,
)
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.waiting import Waiting

KEPT = 500  # messages that are shown again in another fixed frame, where each counts
PATIENCE = 0.5  # s that a message's transform may be late before that is an error
Received = tuple[Any, str]  # a message, and its publisher


class Showing:
    """Of one page. `read(raw)` gives a message and its publisher, or raises Problem."""

    def __init__(self, kind: DisplayType, options: dict[str, Any], view: View,
                 read: Callable[[Any], Received]):
        self._kind, self._view, self._read = kind, view, read
        self._options = options
        self._drawer = kind.make(options)
        self.waiting = Waiting(kind.every, read)
        self._taken: deque[Any] = deque(maxlen=KEPT if kind.every else 1)  # raw
        self._own: Statuses = {"Topic": (WARNING, "No messages received")} if kind.messages else {}
        self._problem: Statuses = {}
        self._late: float | None = None  # s, since when a transform is missing

    @property
    def statuses(self) -> Statuses:
        """As rviz lists them below the display."""
        return {**self._own, **self._drawer.statuses, **self._problem}

    @property
    def namespaces(self) -> list[str]:
        """Of markers, as far as they are known."""
        return self._drawer.namespaces

    def fail(self, name: str, text: str) -> None:
        """A status that something went wrong."""
        self._own[name] = (ERROR, text)

    def stumble(self, error: Exception) -> None:
        """What nobody thought of, until the next look."""
        self._problem["Error"] = (ERROR, f"{type(error).__name__}: {error}")

    def change(self, options: dict[str, Any], fixed_frame: str) -> None:
        """Other options, or another fixed frame: what was shown is shown anew."""
        if options != self._options:
            self._options = options
            self._drawer.restyle(options)
        if fixed_frame != self._view.fixed_frame:
            self._view.fixed_frame = fixed_frame
            self._drawer = self._kind.make(options)
            self.waiting.put_back(list(self._taken))
            self._taken.clear()

    def look(self) -> list[Part] | None:
        """Take what has come, and draw it; None where nothing has changed."""
        self._problem = {}
        self._take()
        try:
            return self._drawer.draw(self._view)
        except NoTransform as problem:
            self._problem["Transform"] = (ERROR, str(problem))
        except (Problem, SimulationError) as problem:
            self._problem["Error"] = (ERROR, str(problem))
        except Exception as error:  # of a message that somebody else made
            self.stumble(error)
        return [] if self._kind.period else None

    def _take(self) -> None:
        if self._kind.every:
            for raw in self.waiting.in_order():
                self._try(lambda raw=raw: self._show(raw, *self._read(raw), None))
        elif self._kind.messages:
            self._try(self._take_newest)

    def _try(self, work: Callable[[], None]) -> None:
        """A message that cannot be shown is told of until one comes that can."""
        try:
            work()
        except (Problem, SimulationError) as problem:
            self.fail("Topic", str(problem))
        except Exception as error:  # of a message that somebody else made
            self.fail("Topic", f"{type(error).__name__}: {error}")

    def _take_newest(self) -> None:
        try:
            found = self.waiting.newest(self._place)
        except NoTransform as problem:
            now = time.monotonic()
            self._late = self._late or now
            if now - self._late > PATIENCE:
                self._own[_sender(self.waiting.publisher)] = (ERROR, str(problem))
            return
        if found is not None:
            raw, (message, publisher), pose = found
            self._late = None
            self._show(raw, message, publisher, pose)
            self._own[_sender(publisher)] = (OK, "Transform OK")

    def _place(self, received: Received) -> Pose:
        header = received[0].header
        return self._view.pose(header.frame_id, header.stamp.to_sec())

    def _show(self, raw: Any, message: Any, publisher: str, pose: Pose | None) -> None:
        self._drawer.take(message, pose, self._view.now)
        self._taken.append(raw)
        self._own["Topic"] = (OK, f"{self.waiting.received} messages received")


def _sender(publisher: str) -> str:
    return f"Transform [sender={publisher}]"
