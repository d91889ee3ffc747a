"""What a submission did that the rules forbid, from the logs of simulator and ROS master.

All other nodes are up before the submission starts, and call nothing more: whatever is logged from
then on was done by the submission, whatever name its nodes have.
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
    """The ROS graph before the submission started, and the parts that it may use."""

    nodes: frozenset[str]
    topics: frozenset[str]  # published or subscribed
    services: frozenset[str]
    parameters: frozenset[str]
    may_publish: frozenset[str]
    may_call: frozenset[str]
    own_calls: Counter[str]  # number of calls by the judge itself, by service


class Conduct:
    """Reads the logs as they grow, and collects violations."""

    def __init__(self, course: Course):
        self._course = course
        self._calls: Counter[str] = Counter()
        self._found: set[str] = set()

    @property
    def violations(self) -> list[str]:
        """One line each, sorted, so that the order does not depend on time."""
        return sorted(self._found)

    def see_state(self, entry: Mapping) -> None:
        """Take a line of the state log; lines with poses are ignored here."""
        if entry.get("shutdown", "").startswith("external shutdown"):
            self._found.add("it ended the node /gazebo")
        if name := entry.get("call"):
            self._calls[name] += 1
            if name not in self._course.may_call and (
                    self._calls[name] > self._course.own_calls[name]):
                self._found.add(f"it called {name}")

    def see_end(self, what: str) -> None:
        """Take note that a node of the course was ended without crashing."""
        if not self._found:
            self._found.add(f"it ended a node of the course: {what}")

    def see_registrations(self, lines: Iterable[str]) -> None:
        """Take new lines of the master's log."""
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
