"""Why a topic may be silent, as far as a subscriber can tell."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

import rospy

from nav_nodes.missing_data import MissingData

QUIET = 1.0  # s of wall time without a message until it is reported


def is_published(topic: rospy.Subscriber) -> bool:
    """Whether a publisher is connected.

    rospy's own count includes killed publishers, which it tries to reconnect to for ever.
    """
    impl = topic.impl
    return impl is not None and any(link.socket is not None for link in impl.connections)


def why_silent(topic: rospy.Subscriber, name: str) -> str:
    """Advice for a topic whose name in the node, before remapping, is `name` ("scan")."""
    if is_published(topic):
        return "its publisher is silent, is the simulation paused?"
    return (f"nobody publishes there {topic.data_class._type} (rostopic info "
            f"{topic.resolved_name}, or {name}:=TOPIC)")


class TopicWatchdog:
    """Notices that a topic is silent, except while a message from it is being processed."""

    def __init__(self, missing_data: MissingData, what: str, name: str) -> None:
        """`what`: the topic's content ("laser scans"); `name`: its name in the node ("scan")."""
        self._missing_data, self._what, self._name = missing_data, what, name
        self._last, self._at_work = time.monotonic(), False

    @contextmanager
    def heard(self) -> Iterator[None]:
        """A context for the processing of a message."""
        self._at_work = True
        try:
            yield
        finally:
            self._last, self._at_work = time.monotonic(), False

    def look(self, topic: rospy.Subscriber) -> None:
        """Call periodically: logs how long it has been silent."""
        what = f"{self._what} on {topic.resolved_name}"
        if not self._at_work and time.monotonic() - self._last > QUIET:
            self._missing_data.missing(what, why_silent(topic, self._name), since=self._last)
        else:
            self._missing_data.present(what)
