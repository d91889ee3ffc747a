"""What a submission did that the rules forbid, from the ROS master's log and the guard's record.

All other nodes are up before the submission starts, and call nothing more: whatever is logged from
then on was done by the submission, whatever name its nodes have.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

# rosmaster's log, master_api.py: "+PUB [/odom] /node http://..." and "+PARAM [/name] by /node"
REGISTRATION = re.compile(r": ([+-])(PUB|SUB|SERVICE|PARAM) \[(.*?)\] (?:by )?(\S*) ?(\S*)")
# By kind of guard.py's refusals
REFUSALS = {"service": "it called {name}",
            "publisher": "it fed {node} a publisher of {name} that the master does not know",
            "parameter": "it sent {node} the parameter {name} past the master",
            "shutdown": "it asked the node {node} to end",
            "launch": "it sent roslaunch a report, which only another roslaunch may"}


LONGEST, MOST = 300, 20  # characters of a violation, violations that are named


@dataclass(frozen=True)
class CourseNodes:
    """The ROS graph before the submission started, and the parts that it may use."""

    nodes: frozenset[str]
    topics: frozenset[str]  # published or subscribed
    services: frozenset[str]
    parameters: frozenset[str]
    may_publish: frozenset[str]


class Conduct:
    """Reads log and record as they grow, and collects violations."""

    def __init__(self, course: CourseNodes):
        self._course = course
        self._publishers: set[tuple[str, str]] = set()  # topic and address, once registered
        self._found: set[str] = set()

    @property
    def violations(self) -> list[str]:
        """One line each, sorted, so that the order does not depend on time."""
        found = sorted(each[:LONGEST] for each in self._found)
        more = [f"and {len(found) - MOST} things more"] if len(found) > MOST else []
        return [*found[:MOST], *more]

    def see_refusals(self, entries: Iterable[Mapping[str, str]]) -> None:
        """Take new entries of the guard's record, after the master's log up to the same moment.

        A node that has unregistered before it could be connected to did nothing wrong.
        """
        for entry in entries:
            if (entry.get("name"), entry.get("uri")) not in self._publishers and "refused" in entry:
                self._found.add(REFUSALS[entry["refused"]].format_map(entry))

    def see_end(self, what: str) -> None:
        """Take note that a node of the course was ended without crashing."""
        if not self._found:
            self._found.add(f"it ended a node of the course: {what}")

    def see_registrations(self, lines: Iterable[str]) -> None:
        """Take new lines of the master's log."""
        for line in lines:
            if found := REGISTRATION.search(line):
                sign, kind, name, node, uri = found.groups()
                if sign + kind == "+PUB":
                    self._publishers.add((name, uri))
                self._found |= set(_of_registration(sign, kind, name, node, self._course))


def _of_registration(sign: str, kind: str, name: str, node: str, course: CourseNodes
                     ) -> Iterator[str]:
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


def _belongs_to_course(parameter: str, course: CourseNodes) -> bool:
    above = parameter.rstrip("/") + "/"
    return parameter in course.parameters or any(
        each.startswith(above) for each in course.parameters) or any(
        parameter.startswith(f"{node}/") for node in course.nodes)
