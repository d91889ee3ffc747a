"""Whether a topic is silent, and why, with a subscriber that is made up."""

from types import SimpleNamespace

import pytest
from sensor_msgs.msg import LaserScan

from nav_nodes import missing_data
from nav_nodes.missing_data import TopicWatchdog, is_published, why_silent


def topic(*sockets):
    """With these connections; None is one that was lost and is tried again."""
    links = [SimpleNamespace(socket=socket) for socket in sockets]
    return SimpleNamespace(impl=SimpleNamespace(connections=links), data_class=LaserScan,
                           resolved_name="/front/scan")


@pytest.mark.parametrize("sockets, published", [((), False), ((None,), False), ((1,), True),
                                                ((None, 1), True)])
def test_a_publisher_that_was_killed_is_none(sockets, published):
    assert is_published(topic(*sockets)) is published


def test_an_unregistered_topic_is_not_published():
    assert not is_published(SimpleNamespace(impl=None))


def test_the_reason_names_type_and_topic_and_what_to_type():
    assert why_silent(topic(), "scan") == (
        "nobody publishes there sensor_msgs/LaserScan (rostopic info /front/scan, or scan:=TOPIC)")
    assert "paused" in why_silent(topic(1), "scan")


def test_who_works_on_a_message_is_not_waiting_for_one(monkeypatch):
    at, said = {"now": 0.0}, []
    monkeypatch.setattr(missing_data.time, "monotonic", lambda: at["now"])
    scans = TopicWatchdog(SimpleNamespace(
        missing=lambda what, _why, since: said.append((what, at["now"] - since)),
        present=lambda what: said.append(what)), "laser scans", "scan")
    name = "laser scans on /front/scan"
    scans.look(topic(1))
    with scans.heard():
        at["now"] = 5.0
        scans.look(topic(1))
    at["now"] = 5.5
    scans.look(topic(1))
    at["now"] = 6.5
    scans.look(topic(1))
    assert said == [name, name, name, (name, 1.5)]
