"""One of several inputs drives the robot until it times out or a higher priority publishes."""

import reprlib
from collections.abc import Mapping
from dataclasses import dataclass, field

DEFAULT_OUTPUT = "output/cmd_vel"
IDLE = "idle"  # what the topic `active` says when nobody holds the robot


class BadFile(ValueError):
    """A YAML file that names no subscribers."""


@dataclass
class Subscriber:
    """One entry of the file: topic, timeout in s, priority."""

    name: str
    topic: str
    timeout: float
    priority: int
    heard: float | None = None


@dataclass
class Holding:
    subscribers: list[Subscriber]
    output: str = DEFAULT_OUTPUT
    holder: Subscriber | None = field(default=None)

    def take(self, speaker: Subscriber, now: float) -> bool:
        """A command came from `speaker` at `now` (s): whether it goes out."""
        speaker.heard = now
        self.let_go(now)
        if self.holder not in (None, speaker) and speaker.priority <= self.holder.priority:
            return False
        self.holder = speaker
        return True

    def let_go(self, now: float) -> None:
        """Nobody holds the robot when its holder has been silent for its timeout.

        Nor when the clock went back, as it does when the simulation is reset.
        """
        if self.holder is not None and not (
                0.0 <= now - self.holder.heard <= self.holder.timeout):
            self.holder = None

    @property
    def active(self) -> str:
        return self.holder.name if self.holder else IDLE


def read_holding(file: object, where: str) -> Holding:
    """Of what a YAML file holds; `where` is its path. Raises BadFile."""
    if not isinstance(file, Mapping) or not isinstance(file.get("subscribers"), list):
        raise BadFile(f"{where} has no list 'subscribers'; each entry needs name, topic, timeout "
                      "and priority")
    subscribers = []
    for i, entry in enumerate(file["subscribers"]):
        try:
            subscribers.append(Subscriber(str(entry["name"]), str(entry["topic"]),
                                          float(entry["timeout"]), int(entry["priority"])))
        except KeyError as error:
            raise BadFile(f"{where}: subscribers[{i}] has no {error.args[0]}") from None
        except (TypeError, ValueError, OverflowError):
            raise BadFile(f"{where}: subscribers[{i}] is {reprlib.repr(entry)[:80]}; it needs "
                          "name, topic, and as numbers timeout and priority") from None
    return Holding(subscribers, str(file.get("publisher", DEFAULT_OUTPUT)))
