"""One display at work: messages in, parts and statuses out. Without ROS and threads of its own."""

import math
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
    Drawer,
    NoTransform,
    Problem,
    Statuses,
    View,
)
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.waiting import Waiting

MOST_KEPT = 500  # messages that a display shows at once, and
MOST_BYTES = 64 << 20  # how large they may be together
JUMP = 2.0  # s; time that goes back by so much was reset
PATIENCE = 0.5  # s that a message's transform may be late before that is an error
Received = tuple[Any, str]  # a message, and its publisher


class Showing:
    """A display of one page. `read(raw)` returns message and publisher, or raises Problem."""

    def __init__(self, kind: DisplayType, options: dict[str, Any], view: View,
                 read: Callable[[Any], Received]):
        self._kind, self._view, self._read = kind, view, read
        self._options = options
        self._drawer = kind.make(options)
        self.waiting = Waiting(kind.every, read)
        self._beside: Any = None  # the last message of the second topic, raw
        self._newest: list[Any] = []  # the last message that was shown, raw
        self._sizes: deque[int] = deque(maxlen=MOST_KEPT)  # bytes, of those that are kept
        self._own: Statuses = {"Topic": (WARNING, "No messages received")} if kind.messages else {}
        self._problem: Statuses = {}
        self._late: float | None = None  # s, since when a transform is missing
        self._now = -math.inf  # s, at the last look
        self._misplaced = False  # whether the page still shows the contents of before `_place_anew`

    @property
    def statuses(self) -> Statuses:
        """As rviz lists them below the display."""
        return {**self._own, **self._drawer.statuses, **self._problem}

    @property
    def drawer(self) -> Drawer:
        """The display's state."""
        return self._drawer

    @property
    def namespaces(self) -> list[str]:
        """Namespaces of markers, as far as they are known."""
        return self._drawer.namespaces

    def put(self, raw: Any, beside: bool = False) -> None:
        """A message has come, on the display's topic or on the one beside. In any thread."""
        if beside and not self._kind.every:
            self._beside = raw
        else:
            self.waiting.put(raw)

    def fail(self, name: str, text: str) -> None:
        """Set an error status."""
        self._own[name] = (ERROR, text)

    def stumble(self, error: Exception) -> None:
        """Set the status of an unexpected error, until something can be drawn."""
        self._problem = {"Error": (ERROR, f"{type(error).__name__}: {error}")}

    def change(self, options: dict[str, Any], fixed_frame: str) -> None:
        """Other options, or another fixed frame: the contents are drawn anew."""
        if options != self._options:
            self._options = options
            self._drawer.restyle(options)
        if fixed_frame != self._view.fixed_frame:
            self._view.fixed_frame = fixed_frame
            self._place_anew()

    def look(self) -> list[Part] | None:
        """Take new messages and draw them; None if nothing has changed."""
        before, self._now = self._now, self._view.now
        if self._now < before - JUMP:
            self._place_anew()
        self._take()
        nothing = [] if self._misplaced else None
        self._misplaced = False
        try:
            parts = self._drawer.draw(self._view)
        except NoTransform as problem:
            self._problem = {"Transform": (ERROR, str(problem))}
        except (Problem, SimulationError) as problem:
            self._problem = {"Error": (ERROR, str(problem))}
        except Exception as error:  # caused by a message of another node
            self.stumble(error)
        else:
            if parts is not None:
                self._problem = {}
            return nothing if parts is None else parts
        return [] if self._kind.period else nothing

    def _place_anew(self) -> None:
        """Place the contents in another fixed frame, or after time was reset."""
        if self._drawer.place_anew():
            return
        self._drawer = self._kind.make(self._options)
        self.waiting.put_back(self._newest)
        self._newest, self._problem, self._misplaced = [], {}, True
        self._sizes.clear()

    def _take(self) -> None:
        if self._kind.every:
            for raw in self.waiting.in_order():
                self._try(lambda raw=raw: self._show(raw, *self._read(raw), None))
        elif self._kind.messages:
            if self._beside is not None:
                self._try(lambda: self._drawer.take(self._read(self._beside)[0], None, self._now))
            self._try(self._take_newest)

    def _try(self, work: Callable[[], None]) -> None:
        """Run `work`; a message that cannot be shown is reported until one comes that can."""
        try:
            work()
        except (Problem, SimulationError) as problem:
            self.fail("Topic", str(problem))
        except Exception as error:  # caused by a message of another node
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
        return self._view.pose(header.frame_id, header.stamp.to_nsec())

    def _show(self, raw: Any, message: Any, publisher: str, pose: Pose | None) -> None:
        self._sizes.append(len(raw._buff))
        while sum(self._sizes) > MOST_BYTES and len(self._sizes) > 1:
            self._sizes.popleft()
        self._drawer.most_kept = len(self._sizes)
        self._drawer.take(message, pose, self._view.now)
        self._newest = [] if self._kind.every else [raw]
        self._own["Topic"] = (OK, f"{self.waiting.received} messages received")


def _sender(publisher: str) -> str:
    return f"Transform [sender={publisher}]"
