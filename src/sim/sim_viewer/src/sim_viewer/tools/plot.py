"""Numbers of any topic over time."""

import math
from collections import deque
from collections.abc import Callable
from typing import Any

from sim_viewer.registry import Refused, argument, operation, watchable
from sim_viewer.subscription import Subscription
from sim_viewer.tools.clock import SharedClock
from sim_viewer.tools.master import MasterView
from sim_viewer.tools.messages import expand, numeric_paths, parse_steps, split_topic, value
from sim_viewer.tools.paced import Paced

MOST_LINES = 24  # of one plot
MOST_WAITING = 5_000  # samples of one line between two sends
MOST_SENT = 100  # samples of one line each time: 500 a second are more than a screen is wide
STAMP_TRUSTED = 5.0  # s; stamps further from now, as in a bag, are not in the present time

Sample = tuple[float, float]  # s, value


@operation("plot_fields")
async def plot_fields(context: Any, topic: str) -> list[str]:
    """The paths of a topic's numbers, to choose from."""
    kind = await context.run_in_thread(context.node.shared(MasterView).message_class, topic)
    return [f"{topic}/{path}" for path in numeric_paths(kind)]


@operation("plot_expand")
async def plot_expand(context: Any, path: str) -> list[str]:
    """The lines that a path names: `/turtle1/pose/x:y` are two."""
    return await context.run_in_thread(lines_of, context.node.shared(MasterView), path)


def lines_of(master: MasterView, path: str) -> list[str]:
    """Full paths to single numbers; Refused, with the choices there are."""
    topic, rest = split_topic("/" + path.strip().strip("/"), master.types())
    return [f"{topic}/{one}" for one in expand(rest, master.message_class(topic))]


@watchable("plot")
class Plot(Paced):
    """Sends `{path: [[time s, value], ...]}` of new messages; NaN and infinity are null."""

    KEEP = True

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        paths = argument(args, "paths", list)
        if not 0 < len(paths) <= MOST_LINES or not all(isinstance(path, str) for path in paths):
            raise Refused(f"paths are 1 to {MOST_LINES} texts such as /odom/pose/pose/position/x")
        self._waiting = {path: deque(maxlen=MOST_WAITING) for path in paths}
        self._clock: SharedClock = context.node.shared(SharedClock)

    def open(self) -> None:
        by_topic: dict[str, list[tuple[str, list]]] = {}
        for path in self._waiting:
            (line,) = lines_of(self.master, path)[:1]
            topic, rest = split_topic(line, self.master.types())
            by_topic.setdefault(topic, []).append((path, parse_steps(rest)))
        self.closing.enter_context(self._clock.held())
        for topic, lines in by_topic.items():
            kind = self.master.message_class(topic)
            self.closing.callback(Subscription(topic, kind, self._taker(lines)).unregister)

    def collect(self) -> Any:
        news = {}
        for path, waiting in self._waiting.items():
            samples = [waiting.popleft() for _ in range(len(waiting))]
            if samples:
                news[path] = thin(samples, MOST_SENT)
        return news or None

    def _taker(self, lines: list[tuple[str, list]]) -> Callable[[Any], None]:
        def take(message: Any) -> None:
            moment = sample_time(message, self._clock.now())
            for path, steps in lines:
                number = value(message, steps)
                if number is not None:
                    self._waiting[path].append((moment, number))
        return take


def sample_time(message: Any, now: float) -> float:
    """The header's stamp, as in rqt_plot; `now` if there is none or it is not near `now`."""
    header = getattr(message, "header", None)
    stamp = header.stamp.to_sec() if hasattr(header, "stamp") else 0.0
    return stamp if stamp and abs(stamp - now) < STAMP_TRUSTED else now


def thin(samples: list[Sample], most: int) -> list[Sample]:
    """At most `most` of the samples, unchanged: of each stretch the lowest and the highest."""
    if len(samples) <= most:
        return samples
    stretch = math.ceil(2 * len(samples) / most)
    kept = []
    for begin in range(0, len(samples), stretch):
        part = [s for s in samples[begin:begin + stretch] if math.isfinite(s[1])]
        ends = sorted({min(part, key=_number), max(part, key=_number)}) if part else []
        kept.extend(ends or samples[begin:begin + 1])
    return kept


def _number(sample: Sample) -> float:
    return sample[1]
