"""One display at work: messages in, parts and statuses out. Without ROS and threads of its own.

A page is sent one frame at a time, and no more points than it draws in time.
"""

import math
import threading
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

FEWEST, MOST = 10_000, 200_000  # points
SLOW, QUICK = 0.5, 0.2  # s from sending a frame until it is drawn
LESS, MORE = 0.5, 1.25  # by how much the number of points changes then
QUEUE = 10  # messages, as in rviz's message filter; older ones are dropped
QUEUE_OF_ALL = 2000  # for displays to which each message counts
MOST_WAITING_BYTES = 32 << 20  # of raw messages, but the newest two stay
MOST_KEPT = 500  # messages that a display shows at once, and
MOST_BYTES = 64 << 20  # how large they may be together
JUMP = 2.0  # s; time that goes back by so much was reset
PATIENCE = 0.5  # s that a message's transform may be late before that is an error
Received = tuple[Any, str]  # a message, and its publisher


class Pace:
    """The pace of one display; times are in s of a monotonic clock."""

    def __init__(self) -> None:
        self.most_points = MOST
        self._number = 0
        self._sent: float | None = None  # when the frame being drawn was sent
        self._large = False

    @property
    def free(self) -> bool:
        """Whether the page has drawn the last frame."""
        return self._sent is None

    def sent(self, points: int, now: float) -> int:
        """Note that a frame with `points` points is sent; returns the frame's number."""
        self._number += 1
        self._sent, self._large = now, points >= self.most_points / 2
        return self._number

    def drawn(self, number: int, now: float) -> bool:
        """The page has drawn a frame; returns whether it is the one that was sent last."""
        if self._sent is None or number != self._number:
            return False
        took, self._sent = now - self._sent, None
        if self._large and took > SLOW:
            self.most_points = max(FEWEST, round(self.most_points * LESS))
        elif self._large and took < QUICK:
            self.most_points = min(MOST, round(self.most_points * MORE))
        return True


class Waiting:
    """A queue of raw messages, which are decoded when they are needed. Thread safe."""

    def __init__(self, every: bool, read: Callable[[Any], tuple[Any, str]]):
        self._queue: deque[list[Any]] = deque(maxlen=QUEUE_OF_ALL if every else QUEUE)
        self._lock = threading.Lock()
        self._read = read
        self.received = 0
        self.publisher = ""  # of the message that was read last

    def put(self, raw: Any) -> None:
        """Add a message."""
        with self._lock:
            self.received += 1
            self._queue.append([raw, None])
            size = sum(len(one._buff) for one, _ in self._queue)
            while size > MOST_WAITING_BYTES and len(self._queue) > 2:
                size -= len(self._queue.popleft()[0]._buff)

    def put_back(self, raws: list[Any]) -> None:
        """Put messages that were shown already before those that wait."""
        with self._lock:
            self._queue.extendleft([raw, None] for raw in reversed(raws))

    def in_order(self) -> list[Any]:
        """Remove and return all raw messages, oldest first."""
        with self._lock:
            found = [raw for raw, _ in self._queue]
            self._queue.clear()
        return found

    def newest(self, ready: Callable[[Any], Any]) -> tuple[Any, tuple[Any, str], Any] | None:
        """The newest message for which `ready` raises no ValueError: raw, as read, and the result
        of `ready`; older ones are dropped. One that cannot be read is, too, and its error raised.

        If none is ready, the newest one's ValueError is raised.
        """
        with self._lock:
            entries = list(self._queue)
        problem = None
        for entry in reversed(entries):
            if entry[1] is None:
                self._read_entry(entry)
            try:
                found = ready(entry[1])
            except ValueError as error:
                problem = problem or error
                continue
            self._drop(entry)
            return entry[0], entry[1], found
        if problem is not None:
            raise problem
        return None

    def _read_entry(self, entry: list[Any]) -> None:
        try:
            entry[1] = self._read(entry[0])
        except Exception:
            self._drop(entry)
            raise
        self.publisher = entry[1][1]

    def _drop(self, last: list[Any]) -> None:
        """Remove this entry and all before it."""
        with self._lock:
            while self._queue:
                if self._queue.popleft() is last:
                    break


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
