"""The log of all nodes, as rqt_console shows it."""

import itertools
from collections import deque
from typing import Any

from rosgraph_msgs.msg import Log

from sim_viewer.registry import Refused, argument, watchable
from sim_viewer.subscription import SharedSubscription, Subscription
from sim_viewer.tools import names
from sim_viewer.tools.paced import Paced

LEVELS = {"debug": Log.DEBUG, "info": Log.INFO, "warn": Log.WARN, "error": Log.ERROR,
          "fatal": Log.FATAL}
NAMES = {number: name for name, number in LEVELS.items()}
MOST_REMEMBERED = 1_000
MOST_LETTERS = 2_000  # of one line
MOST_SENT = 200  # lines each time; more could not be read


class SharedLog(SharedSubscription):
    """The last lines, collected while somebody watches, and kept afterwards."""

    def __init__(self, node: Any = None):
        super().__init__(node)
        self._lines: deque[tuple[int, dict[str, Any]]] = deque(maxlen=MOST_REMEMBERED)
        self._numbers = itertools.count(1)

    def subscribe(self) -> Subscription:
        """Subscribe anew; the numbering of lines continues."""
        return Subscription(names.ROSOUT, Log, self._take)

    def after(self, number: int) -> list[tuple[int, dict[str, Any]]]:
        """Lines with a higher number than this, oldest first."""
        return [line for line in list(self._lines) if line[0] > number]

    def _take(self, message: Log) -> None:
        self._lines.append((next(self._numbers), line_of(message)))


def line_of(message: Log) -> dict[str, Any]:
    """One line for the page; `time` in s, `level` by name."""
    text = message.msg
    if len(text) > MOST_LETTERS:
        text = text[:MOST_LETTERS] + f" ... {len(message.msg) - MOST_LETTERS} more letters"
    return {"time": message.header.stamp.to_sec(), "level": NAMES.get(message.level, "info"),
            "node": message.name, "text": text,
            "place": f"{message.file}:{message.line} {message.function}"}


def pick(lines: list[dict[str, Any]], level: str) -> list[dict[str, Any]]:
    """The lines of at least the severity `level`."""
    return [line for line in lines if LEVELS[line["level"]] >= LEVELS[level]]


@watchable("console")
class Console(Paced):
    """Sends `{"lines": [{time, level, node, text, place}], "left_out": n}`, remembered ones first.

    Only levels are filtered here. The page filters by regular expression itself: a bad one may
    take minutes, and then blocks only the page where it was typed.
    """

    KEEP = True

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._level = argument(args, "level", str, "debug")
        if self._level not in LEVELS:
            raise Refused(f"level is {self._level!r:.40}; there are {', '.join(LEVELS)}")
        self._log: SharedLog = context.node.shared(SharedLog)
        self._number = 0

    def open(self) -> None:
        self.closing.enter_context(self._log.held())

    def collect(self) -> Any:
        fresh = self._log.after(self._number)
        if not fresh:
            return None
        self._number = fresh[-1][0]
        lines = pick([line for _, line in fresh], self._level)
        if not lines:
            return None
        return {"lines": lines[-MOST_SENT:], "left_out": max(0, len(lines) - MOST_SENT)}
