"""Which nodes are connected to which, as the master and the nodes report it."""

from __future__ import annotations

import contextlib
import socket
import threading
import xmlrpc.client
from collections.abc import Iterable
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException
from xml.parsers.expat import ExpatError

import rosgraph

ANSWER_TIME = 1.0  # s, wall, for one answer of a node


@dataclass(frozen=True)
class Connections:
    """Node names by topic, and the publishers' open links: (publisher, topic, subscriber).

    The master knows which nodes should be connected; only the publisher knows which are.
    """

    publishers: dict[str, frozenset[str]]
    subscribers: dict[str, frozenset[str]]
    links: frozenset[tuple[str, str, str]]

    def missing_link(self, topic: str) -> str | None:
        """The first connection of this topic that is not open yet, in words; None if all are."""
        for publisher in sorted(self.publishers[topic]):
            for subscriber in sorted(self.subscribers[topic] - {publisher}):
                if (publisher, topic, subscriber) not in self.links:
                    return f"the connection of {topic} from {publisher} to {subscriber}"
        return None


def look_up(master_uri: str, caller: str, topics: Iterable[str]) -> Connections:
    """Query the master and each publisher of these topics; one that does not answer has no links.

    Raises OSError, xmlrpc.client.Error or rosgraph.MasterException if the master fails.
    """
    master = rosgraph.Master(caller, master_uri)
    publishing, subscribing, _ = master.getSystemState()
    publishers = {topic: frozenset(nodes) for topic, nodes in publishing}
    subscribers = {topic: frozenset(nodes) for topic, nodes in subscribing}
    nobody: frozenset[str] = frozenset()
    wanted = {topic: publishers.get(topic, nobody) for topic in topics}
    nodes = nobody.union(*wanted.values())
    return Connections(
        wanted,
        {topic: subscribers.get(topic, nobody) for topic in wanted},
        frozenset(link for node in nodes for link in _links_of(master, caller, node)),
    )


def _links_of(master: rosgraph.Master, caller: str, node: str) -> list[tuple[str, str, str]]:
    """A node's outgoing connections, from its getBusInfo (ROS slave API)."""
    try:
        slave = xmlrpc.client.ServerProxy(master.lookupNode(node), ImpatientTransport())
        _, _, connections = slave.getBusInfo(caller)
        return [
            (node, str(topic), str(receiver))
            for _, receiver, direction, _, topic, is_open, *_ in connections
            if direction == "o" and is_open
        ]
    except (OSError, xmlrpc.client.Error, HTTPException, ExpatError, rosgraph.MasterException,
            AttributeError, LookupError, TypeError, ValueError):
        return []  # it hangs, is gone, or its answer is malformed


class ImpatientTransport(xmlrpc.client.Transport):
    """Hangs up after ANSWER_TIME, because a node may hang, or answer without an end."""

    def make_connection(self, host: str) -> HTTPConnection:
        self._connection = host, _Connection(host, timeout=ANSWER_TIME)
        return self._connection[1]

    def single_request(self, *request: object, **options: object) -> object:
        limit = threading.Timer(ANSWER_TIME, lambda: self._connection[1].hang_up())
        limit.start()
        try:
            return super().single_request(*request, **options)
        finally:
            limit.cancel()


class _Connection(HTTPConnection):
    """Can be ended while an answer is read, for which HTTPConnection lets its socket go."""

    _connected: socket.socket | None = None

    def connect(self) -> None:
        super().connect()
        self._connected = self.sock

    def hang_up(self) -> None:
        """From another thread: whoever reads then finds the end."""
        if self._connected is not None:
            with contextlib.suppress(OSError):  # it has just ended
                self._connected.shutdown(socket.SHUT_RDWR)
