"""Who drives when several would."""

from pathlib import Path

import pytest
import yaml
from twist_mux.priorities import BadEntry, Priorities, Source, read_sources

CONFIG = Path(__file__).parent.parent / "config"


def sources():
    return (Source("navigation", "nav_vel", 0.5, 10), Source("joystick", "joy_vel", 0.5, 100))


def test_highest_priority_drives_until_it_falls_silent():
    navigation, joystick = sources()
    priorities = Priorities([navigation, joystick], [])
    navigation.heard = 1.0
    assert priorities.may_drive(navigation, 1.0)
    joystick.heard = 1.1
    assert priorities.may_drive(joystick, 1.1)
    navigation.heard = 1.5
    assert not priorities.may_drive(navigation, 1.5)
    navigation.heard = 1.7
    assert priorities.may_drive(navigation, 1.7)


def test_a_lock_holds_back_what_is_below_it():
    navigation, joystick = sources()
    lock = Source("pause", "pause", 0.0, 100)
    priorities = Priorities([navigation, joystick], [lock])
    navigation.heard = joystick.heard = 1.0
    lock.locked = True
    assert priorities.may_drive(joystick, 1.0)
    joystick.heard = None
    assert not priorities.may_drive(navigation, 1.0)
    lock.locked = False
    assert priorities.may_drive(navigation, 1.0)


def test_a_lock_with_a_timeout_locks_while_nobody_says_that_it_is_open():
    navigation, _ = sources()
    lock = Source("watchdog", "watchdog", 0.2, 255)
    priorities = Priorities([navigation], [lock])
    navigation.heard = 1.0
    assert not priorities.may_drive(navigation, 1.0)
    lock.heard = 0.9
    assert priorities.may_drive(navigation, 1.0)
    assert not priorities.may_drive(navigation, 1.2)


def test_timeout_zero_never_grows_old_and_priority_zero_never_drives():
    for_ever, never = Source("a", "a", 0.0, 5), Source("b", "b", 0.5, 0)
    for_ever.heard = never.heard = 0.0
    assert Priorities([for_ever], []).may_drive(for_ever, 1e6)
    assert not Priorities([never], []).may_drive(never, 0.0)


@pytest.mark.parametrize("entries, said", [
    ({"a": 1}, "~topics is .* not a list"),
    ([{"name": "a", "topic": "b"}], r"~topics\[0\] has no timeout, priority"),
    ([3], r"~topics\[0\] is 3"),
    ([{"name": "a", "topic": "b", "timeout": "x", "priority": 1}], "have to be numbers"),
    ([{"name": "a", "topic": "b", "timeout": 1, "priority": 256}], "priority 256 from 0 to 255")])
def test_entries_that_cannot_be_used(entries, said):
    with pytest.raises(BadEntry, match=said):
        read_sources(entries, "~topics")


@pytest.mark.parametrize("name", ["topics", "locks"])
def test_shipped_files(name):
    entries = yaml.safe_load((CONFIG / f"twist_mux_{name}.yaml").read_text(encoding="utf-8"))
    assert read_sources(entries[name], name)
