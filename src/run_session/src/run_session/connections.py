"""Who is connected to whom, as the master and the nodes themselves say it."""

from __future__ import annotations

import xmlrpc.client
from collections.abc import Iterable
from dataclasses import dataclass

import rosgraph

ANSWER_TIME = 1.0  # s, wall, for one answer of a node


@dataclass(frozen=True)
class Connections:
    """Node names by topic, and the links that publishers have open: (publisher, topic, subscriber).

    The master knows who wants to be connected; only the publisher knows who is.
    """

    publishers: dict[str, frozenset[str]]
    subscribers: dict[str, frozenset[str]]
    links: frozenset[tuple[str, str, str]]

    def missing_link(self, topic: str) -> str | None:
        """The first link of this topic that is wanted and not open yet, in words."""
        for publisher in sorted(self.publishers[topic]):
            for subscriber in sorted(self.subscribers[topic] - {publisher}):
                if (publisher, topic, subscriber) not in self.links:
                    return f"the connection of {topic} from {publisher} to {subscriber}"
        return None


def look_up(master_uri: str, caller: str, topics: Iterable[str]) -> Connections:
    """Ask the master, and each publisher of these topics; one that does not answer has no links.

    Raises OSError, xmlrpc.client.Error or rosgraph.MasterException where the master fails.
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
    """What a node publishes to, from its getBusInfo (ROS slave API)."""
    try:
        slave = xmlrpc.client.ServerProxy(master.lookupNode(node), _ImpatientTransport())
        _, _, connections = slave.getBusInfo(caller)
        return [
            (node, str(topic), str(receiver))
            for _, receiver, direction, _, topic, is_open, *_ in connections
            if direction == "o" and is_open
        ]
    except (OSError, xmlrpc.client.Error, rosgraph.MasterException, TypeError, ValueError):
        return []  # it hangs, is gone, or answers what is no answer


class _ImpatientTransport(xmlrpc.client.Transport):
    """Does not wait for ever for a node that hangs."""

    def make_connection(self, host: str) -> object:
        connection = super().make_connection(host)
        connection.timeout = ANSWER_TIME
        return connection
