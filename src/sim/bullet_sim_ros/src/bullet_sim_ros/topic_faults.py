"""Names what is wrong with who sends and who hears: the faults that a learner cannot see.

Two nodes that drive one robot, a command on a topic that nobody hears or of a type that is not
taken there, an image that nobody publishes. Each is one warning once it has lasted for PATIENCE, in
wall time.
"""

import logging
import re
import threading
import time
import xmlrpc.client
from collections.abc import Callable, Hashable, Iterator
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from http.client import HTTPException
from typing import Any, NamedTuple
from xml.parsers.expat import ExpatError

import rosgraph
import rospy
from rosgraph.masterapi import MasterException

from bullet_sim_ros.already_running import ImpatientTransport

log = logging.getLogger("bullet_sim.topics")

PATIENCE = 5.0  # s that a fault lasts before it is said
LOOK = 1.0      # s between two looks
RECENT = 1.0    # s; who has sent within this time still drives
ANSWER_TIME = 1.0  # s for a node's answer
AGAIN = 60.0    # s until a fault that came back is said again
COMMANDS = {"geometry_msgs/Twist", "geometry_msgs/Wrench", "std_msgs/Float64",
            "std_msgs/Float64MultiArray", "trajectory_msgs/JointTrajectory"}
SENSORS = {"sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/LaserScan",
           "sensor_msgs/PointCloud2", "sensor_msgs/Imu"}
# These show what is missing; an anonymous node has numbers behind its name.
SAID_ELSEWHERE = re.compile(r".*/(rviz|rqt_\w+|sim_viewer|record|rosout)(_\d+)*")
ANY = "*"  # type of a node that takes or relays all
ALIKE = 0.8  # of two names that may mean the same
MOST = 5  # names in a line


class Fault(NamedTuple):
    """What is said of it: a format and its values; `key` is the same while it is the same fault."""

    key: Hashable
    text: str
    values: tuple[Any, ...]


@dataclass(frozen=True)
class Graph:
    """Nodes by topic, and each topic's type, as the master has them.

    `mistyped`: nodes that are no publishers because the simulator takes another type from the
    topic, each as (node, its type, topic, the type that is taken).
    """

    publishers: dict[str, list[str]]
    subscribers: dict[str, list[str]]
    types: dict[str, str]
    mistyped: tuple[tuple[str, str, str, str], ...] = ()


class Senders:
    """Who sent a command last, and when; thread-safe."""

    def __init__(self) -> None:
        self._last: dict[str, dict[str, float]] = {}
        self._lock = threading.Lock()

    def note(self, topic: str, message: Any) -> None:
        """A message came on a topic."""
        caller = (getattr(message, "_connection_header", None) or {}).get("callerid")
        if caller:
            with self._lock:
                self._last.setdefault(topic, {})[caller] = time.monotonic()

    def recent(self, now: float) -> dict[str, list[str]]:
        """Nodes by topic that sent within RECENT before `now` (time.monotonic)."""
        with self._lock:
            self._last = {topic: recent for topic, callers in self._last.items() if (recent := {
                caller: last for caller, last in callers.items() if now - last <= RECENT})}
            return {topic: sorted(callers) for topic, callers in self._last.items()}


def contested(senders: dict[str, list[str]], types: dict[str, str]) -> Iterator[Fault]:
    """Several nodes that send commands on the same topics: one fault for all of these."""
    topics: dict[tuple[str, ...], list[str]] = {}
    for topic, nodes in senders.items():
        if len(nodes) > 1 and types.get(topic) in COMMANDS:
            topics.setdefault(tuple(nodes), []).append(topic)
    for nodes, shared in topics.items():
        yield Fault(("contested", *nodes),
                    "%s send commands on %s at the same time, so the robot follows now one, now "
                    "the other: end one of them (Ctrl-C in its terminal, or rosnode kill)",
                    (", ".join(nodes), _listed(shared)))


def typed(graph: Graph, me: str, ask: Callable[[str, str], dict[str, str]]) -> Graph:
    """The graph with those who send what the simulator does not take as `mistyped`.

    The master has one type of a topic, that of its newest publisher; `ask` a node by a call of its
    API, getPublications or getSubscriptions, for its types by topic.
    """
    shared = {topic: [node for node in nodes if node != me]
              for topic, nodes in graph.publishers.items()
              if me in graph.subscribers.get(topic, [])}
    senders = {node for nodes in shared.values() for node in nodes}
    takes = ask(me, "getSubscriptions") if senders else {}
    sends = {node: ask(node, "getPublications") for node in sorted(senders)}
    wrong = tuple((node, sends[node][topic], topic, takes[topic])
                  for topic, nodes in sorted(shared.items()) for node in nodes
                  if ANY not in (takes.get(topic, ANY), sends[node].get(topic, ANY))
                  and takes[topic] != sends[node][topic])
    out = {(topic, node) for node, _, topic, _ in wrong}
    publishers = {topic: [node for node in nodes if (topic, node) not in out]
                  for topic, nodes in graph.publishers.items()}
    return replace(graph, mistyped=wrong,
                   publishers={topic: nodes for topic, nodes in publishers.items() if nodes},
                   types=graph.types | {topic: taken for _, _, topic, taken in wrong})


def mistyped(graph: Graph) -> Iterator[Fault]:
    """Nodes that send what the simulator does not take there."""
    for node, sent, topic, taken in graph.mistyped:
        yield Fault(("mistyped", topic, node),
                    "%s sends %s on %s, which takes %s, so none of it arrives: end it, and send %s",
                    (node, sent, topic, taken, taken))


def ask_node(node: str, call: str) -> dict[str, str]:
    """What a node says of its topics, by a call of its API; nothing if it does not answer."""
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
        api = xmlrpc.client.ServerProxy(uri, ImpatientTransport(ANSWER_TIME))
        return {str(topic): str(kind) for topic, kind in getattr(api, call)(rospy.get_name())[2]}
    except (OSError, MasterException, HTTPException, ExpatError, xmlrpc.client.Error,
            LookupError, TypeError, ValueError):
        return {}


def unheard(graph: Graph, me: str) -> Iterator[Fault]:
    """Command topics without a subscriber, while a robot's own command topic has no publisher."""
    idle = [topic for topic, nodes in graph.subscribers.items()
            if me in nodes and not graph.publishers.get(topic)]
    for topic, nodes in graph.publishers.items():
        kind = graph.types.get(topic)
        if kind not in COMMANDS or graph.subscribers.get(topic) or me in nodes:
            continue
        meant = [other for other in idle if graph.types.get(other) == kind
                 and (kind == "geometry_msgs/Twist" or _alike(topic, other))]
        if meant:
            yield Fault(("unheard", topic, *nodes),
                        "%s sends commands on %s, but nobody hears them there; the robot listens "
                        "on %s", (" and ".join(nodes), topic, _nearest(topic, meant)))


def unseen(graph: Graph, me: str) -> Iterator[Fault]:
    """Sensor topics with a subscriber and no publisher, while the simulator's have other names."""
    for topic, everybody in graph.subscribers.items():
        kind = graph.types.get(topic)
        nodes = [node for node in everybody
                 if node != me and not SAID_ELSEWHERE.fullmatch(node)]
        if kind not in SENSORS or not nodes or graph.publishers.get(topic):
            continue
        meant = [other for other, by in graph.publishers.items()
                 if me in by and graph.types.get(other) == kind]
        if meant:
            yield Fault(("unseen", topic, *nodes),
                        "%s waits for %s on %s, but nobody publishes it; the simulator publishes "
                        "%s", (" and ".join(nodes), kind, topic, _nearest(topic, meant)))


def _alike(first: str, second: str) -> bool:
    return (first.rpartition("/")[2] == second.rpartition("/")[2]
            or _likeness(first, second) > ALIKE)


def _likeness(first: str, second: str) -> float:
    return SequenceMatcher(None, first, second).ratio()


def _nearest(topic: str, others: list[str]) -> str:
    """The names that come nearest, the nearest first."""
    near = sorted(others, key=lambda other: (-_likeness(topic, other), other))
    return _listed(near)


def _listed(names: list[str]) -> str:
    return ", ".join(names[:MOST]) + (" ..." if len(names) > MOST else "")


class Reports:
    """Each fault once, when it has lasted for PATIENCE."""

    def __init__(self) -> None:
        self._since: dict[Hashable, float] = {}
        self._said: dict[Hashable, float] = {}

    def due(self, faults: list[Fault], now: float) -> list[Fault]:
        """Those to be said now, of all that there are at `now` (time.monotonic)."""
        self._since = {fault.key: self._since.get(fault.key, now) for fault in faults}
        due = []
        for fault in faults:
            if now - self._since[fault.key] < PATIENCE:
                continue
            last = self._said.get(fault.key)
            self._said[fault.key] = now  # also while it lasts: it is said again only if it ended
            if last is None or now - last > AGAIN:
                due.append(fault)
        return due


def watch(senders: Senders) -> None:
    """Look for faults every LOOK until shutdown, in a thread; after init_node."""
    threading.Thread(target=_watch, args=(senders,), daemon=True).start()


def _watch(senders: Senders) -> None:
    master, reports, me = rosgraph.Master(rospy.get_name()), Reports(), rospy.get_name()
    last = graph = Graph({}, {}, {})
    ended = threading.Event()
    rospy.on_shutdown(ended.set)
    while not ended.wait(LOOK):
        try:
            now_there = _graph(master, last)
        except (OSError, MasterException, HTTPException, ExpatError):
            continue  # the master is busy, or has ended, which others say
        if now_there is not last:
            last, graph = now_there, typed(now_there, me, ask_node)
        now = time.monotonic()
        faults = [*contested(senders.recent(now), graph.types), *mistyped(graph),
                  *unheard(graph, me), *unseen(graph, me)]
        for fault in reports.due(faults, now):
            log.warning(fault.text, *fault.values)


def _graph(master: rosgraph.Master, last: Graph) -> Graph:
    """As it is now; types, which come with registrations, are not asked for if it is the last one.
    """
    publishers, subscribers = map(dict, master.getSystemState()[:2])
    if (publishers, subscribers) == (last.publishers, last.subscribers):
        return last
    return Graph(publishers, subscribers, dict(master.getTopicTypes()))
