"""What a submission did that the rules do not allow, as simulator and ROS master saw it.

All other nodes are up, and call nothing more, before the submission starts: what is logged from
then on is its doing, whatever name it gives itself.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

# rosmaster's log, master_api.py: "+PUB [/odom] /node http://..." and "+PARAM [/name] by /node"
REGISTRATION = re.compile(r": ([+-])(PUB|SUB|SERVICE|PARAM) \[(.*?)\] (?:by )?(\S*)")


@dataclass(frozen=True)
class Course:
    """What was there before the submission started, and what it may use of it."""

    nodes: frozenset[str]
    topics: frozenset[str]  # published or subscribed
    services: frozenset[str]
    parameters: frozenset[str]
    may_publish: frozenset[str]
    may_call: frozenset[str]
    own_calls: Counter[str]  # services that the judge itself calls, and how often


class Conduct:
    """Reads the logs as they grow; what was found stays."""

    def __init__(self, course: Course):
        self._course = course
        self._calls: Counter[str] = Counter()
        self._found: set[str] = set()

    @property
    def violations(self) -> list[str]:
        """One line each; in an order that does not depend on when they were seen."""
        return sorted(self._found)

    def see_state(self, entry: Mapping) -> None:
        """A line of the state log; those with poses say nothing here."""
        if entry.get("shutdown", "").startswith("external shutdown"):
            self._found.add("it ended the node /gazebo")
        if name := entry.get("call"):
            self._calls[name] += 1
            if name not in self._course.may_call and (
                    self._calls[name] > self._course.own_calls[name]):
                self._found.add(f"it called {name}")

    def see_end(self, what: str) -> None:
        """A part of the course ended, and did not crash."""
        if not self._found:
            self._found.add(f"it ended a node of the course: {what}")

    def see_registrations(self, lines: Iterable[str]) -> None:
        """New lines of the master's log."""
        for line in lines:
            if found := REGISTRATION.search(line):
                self._found |= set(_of_registration(*found.groups(), self._course))


def _of_registration(sign: str, kind: str, name: str, node: str, course: Course) -> Iterator[str]:
    if kind == "PARAM":
        if _belongs_to_course(name, course):
            yield f"it {'changed' if sign == '+' else 'deleted'} the parameter {name}"
    elif node in course.nodes:
        yield (f"it took the name of the node {node}" if sign == "+" else
               f"it unregistered the node {node}")
    elif sign == "+" and kind == "SERVICE" and name in course.services:
        yield f"it offered the service {name} in place of the course's"
    elif sign == "+" and kind == "PUB" and name in course.topics - course.may_publish:
        yield f"it published {name}"


def _belongs_to_course(parameter: str, course: Course) -> bool:
    above = parameter.rstrip("/") + "/"
    return parameter in course.parameters or any(
        each.startswith(above) for each in course.parameters) or any(
        parameter.startswith(f"{node}/") for node in course.nodes)
