"""What a submission did that the rules do not allow, as simulator and ROS master saw it.

All other nodes are up, and call nothing more, before the submission starts: what is logged from
then on is its doing, whatever name it gives itself.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator
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


def violations(master_log: Iterable[str], state_log: Iterable[str], course: Course) -> list[str]:
    """One line each, in the order in which they were seen first."""
    found = [*_of_calls(state_log, course), *_of_registrations(master_log, course)]
    return list(dict.fromkeys(found))


def _of_calls(lines: Iterable[str], course: Course) -> Iterator[str]:
    calls: Counter[str] = Counter()
    for line in lines:
        entry = json.loads(line)
        if entry.get("shutdown", "").startswith("external shutdown"):
            yield "it ended the node /gazebo"
        name = entry.get("call")
        if name is None:
            continue
        calls[name] += 1
        if name not in course.may_call and calls[name] > course.own_calls[name]:
            yield f"it called {name}"


def _of_registrations(lines: Iterable[str], course: Course) -> Iterator[str]:
    for line in lines:
        found = REGISTRATION.search(line)
        if not found:
            continue
        sign, kind, name, node = found.groups()
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
