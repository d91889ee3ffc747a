"""Data that a node waits for: what is said, and once, by watchdogs of topics and of all inputs."""

import uuid
from types import SimpleNamespace

import pytest
import rospy
from sensor_msgs.msg import LaserScan

from nav_nodes import missing_data
from nav_nodes.missing_data import MissingData, TopicWatchdog, is_published, why_silent


@pytest.fixture
def say(monkeypatch):
    """Lets time run and collects (s, line); `say.missing_data` are to be used."""
    at = {"now": 0.0}
    terminal = uuid.uuid4().int  # tests run beside each other
    monkeypatch.setattr(missing_data.os, "getppid", lambda: terminal)
    monkeypatch.setattr(missing_data.time, "monotonic", lambda: at["now"])
    lines = []
    monkeypatch.setattr(rospy, "logwarn", lambda text, *values: lines.append(
        (at["now"], text % values)))
    monkeypatch.setattr(rospy, "loginfo", lambda text, *values: lines.append(
        (at["now"], text % values)))

    def run(until, act):
        """`act(now)` every 0.25 s; what was said meanwhile."""
        del lines[:]
        while at["now"] < until:
            at["now"] += 0.25
            act(at["now"])
        return list(lines)

    run.missing_data = MissingData()
    return run


def test_one_thing_is_said_after_a_second_and_then_every_five(say):
    assert say(12.0, lambda _: say.missing_data.missing("map", "start map_server")) == [
        (1.75, "no map for 2 s: start map_server"), (6.75, "no map for 6 s: start map_server"),
        (11.75, "no map for 12 s: start map_server")]


def test_what_comes_back_in_time_is_never_said(say):
    def now_and_then(now):
        (say.missing_data.missing if now % 1.0 else say.missing_data.present)("map")
    assert say(20.0, now_and_then) == []


def test_there_again_is_said_once_and_the_next_absence_begins_anew(say):
    say(3.0, lambda _: say.missing_data.missing("map"))
    assert say(4.0, lambda _: say.missing_data.present("map")) == [(3.25, "map: there again")]
    assert say(6.0, lambda _: say.missing_data.missing("map")) == [(5.75, "no map for 2 s")]


def test_two_things_at_a_time_are_one_line(say):
    def both(now):
        say.missing_data.missing("map")
        if now > 0.25:
            say.missing_data.missing("scan", "is the laser on?")
    assert say(7.0, both) == [(1.75, "no map for 2 s; no scan for 1 s: is the laser on?"),
                              (6.75, "no map for 6 s; no scan for 6 s: is the laser on?")]


def test_what_comes_later_is_said_when_it_comes_and_then_with_the_first(say):
    def later(now):
        say.missing_data.missing("map")
        if now > 2.0:
            say.missing_data.missing("scan")
    assert say(14.0, later) == [(1.75, "no map for 2 s"), (3.75, "no scan for 2 s"),
                                (8.75, "no map for 8 s; no scan for 6 s"),
                                (13.75, "no map for 14 s; no scan for 12 s")]


def test_while_a_root_is_missing_nothing_else_is_said(say):
    def all_of_it(now):
        say.missing_data.missing("scan")
        if now < 7.0:
            say.missing_data.missing("clock", is_root=True)
        else:
            say.missing_data.present("clock")
    assert say(8.0, all_of_it) == [(1.75, "no clock for 2 s"), (6.75, "no clock for 6 s"),
                                   (7.0, "clock: there again"), (7.25, "no scan for 7 s")]


def test_one_node_of_a_launch_says_what_all_miss(say, monkeypatch):
    def nobody_ticks(missing_data):
        return lambda _: missing_data.missing("clock", is_root=True)
    other = MissingData()
    assert len(say(2.0, nobody_ticks(other))) == 1
    assert say(12.0, nobody_ticks(say.missing_data)) == []
    monkeypatch.setattr(missing_data.os, "getppid", lambda: 0)  # in another terminal
    assert say(19.0, nobody_ticks(say.missing_data))


def test_when_its_process_ends_another_one_says_it(say):
    first = MissingData()
    assert say(2.0, lambda _: first.missing("clock", is_root=True))
    first._speaker._held.close()
    assert say(9.0, lambda _: say.missing_data.missing("clock", is_root=True))


def test_a_result_is_not_said_with_its_cause(say):
    def three(now):
        say.missing_data.missing("localisation", is_result=True)
        if now < 9.0:
            say.missing_data.missing("laser", patience=5.0)
        else:
            say.missing_data.present("laser")
    assert say(9.25, three) == [(5.75, "no laser for 6 s"), (9.0, "laser: there again"),
                                (9.25, "no localisation for 9 s")]


def test_what_is_missing_for_long_is_no_cause(say):
    def two(now):
        say.missing_data.missing("bumper")
        if now > 20.0:
            say.missing_data.missing("localisation", is_result=True)
    say(20.0, two)
    assert say(21.75, two) == [(21.75, "no localisation for 2 s")]


def test_the_least_patient_counts_and_how_long_it_was_missing_before(say):
    def two(_):
        say.missing_data.missing("scan", "is the laser on?", patience=5.0)
        say.missing_data.missing("scan", "the robot stands", since=-2.0)
    assert say(1.0, two) == [(0.25, "no scan for 2 s: the robot stands")]


def test_what_nobody_asks_about_any_more_is_not_missing(say):
    say(3.0, lambda _: say.missing_data.missing("odometry"))
    assert say(30.0, lambda _: None) == []
    assert say(32.0, lambda _: say.missing_data.missing("odometry")) == [
        (31.75, "no odometry for 2 s")]


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
