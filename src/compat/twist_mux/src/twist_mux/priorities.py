"""Who may drive: the highest priority among the topics that are alive and not locked."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

LOWEST, HIGHEST = 0, 255


class BadEntry(ValueError):
    """An entry of ~topics or ~locks that cannot be used."""


@dataclass
class Source:
    """One entry of the YAML file; times in s.

    One whose timeout is 0 never grows old, even if nothing ever came from it, as upstream.
    """

    name: str
    topic: str
    timeout: float
    priority: int
    heard: float | None = None
    locked: bool = False  # of a lock: what its topic said last

    def expired(self, now: float) -> bool:
        """Silent for its timeout, or heard before the clock went back."""
        return self.timeout > 0.0 and (
            self.heard is None or not 0.0 <= now - self.heard <= self.timeout)


@dataclass
class Priorities:
    topics: list[Source]
    locks: list[Source]

    def may_drive(self, source: Source, now: float) -> bool:
        """Whether a command that just came from `source` goes out."""
        floor = max((lock.priority for lock in self.locks if lock.expired(now) or lock.locked),
                    default=LOWEST)
        first, best = None, LOWEST
        for topic in self.topics:
            if not topic.expired(now) and topic.priority >= floor and topic.priority > best:
                first, best = topic, topic.priority
        return first is source


def read_sources(entries: object, where: str) -> list[Source]:
    """Sources of the list that parameter `where` holds; raises BadEntry."""
    if not isinstance(entries, Sequence) or isinstance(entries, str):
        raise BadEntry(f"{where} is {entries!r}, not a list; load a YAML file with a list of "
                       "name, topic, timeout and priority")
    return [_source(entry, f"{where}[{i}]") for i, entry in enumerate(entries)]


def _source(entry: object, where: str) -> Source:
    if not isinstance(entry, Mapping):
        raise BadEntry(f"{where} is {entry!r}; it needs name, topic, timeout and priority")
    if missing := [key for key in ("name", "topic", "timeout", "priority") if key not in entry]:
        raise BadEntry(f"{where} has no {', '.join(missing)}")
    try:
        timeout, priority = float(entry["timeout"]), int(entry["priority"])
    except (TypeError, ValueError):
        raise BadEntry(f"{where}: timeout {entry['timeout']!r} and priority "
                       f"{entry['priority']!r} have to be numbers") from None
    if timeout < 0.0 or not LOWEST <= priority <= HIGHEST:
        raise BadEntry(f"{where}: timeout {timeout:g} has to be 0 or more, priority {priority} "
                       f"from {LOWEST} to {HIGHEST}")
    return Source(str(entry["name"]), str(entry["topic"]), timeout, priority)
