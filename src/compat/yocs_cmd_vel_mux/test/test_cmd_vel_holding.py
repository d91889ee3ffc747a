"""Who holds the robot when several would."""

import pytest
from yocs_cmd_vel_mux.holding import BadFile, read_holding

FILE = {"subscribers": [{"name": "safety", "topic": "input/safety", "timeout": 0.2, "priority": 10},
                        {"name": "teleop", "topic": "input/teleop", "timeout": 0.5, "priority": 7},
                        {"name": "other", "topic": "input/other", "timeout": 0.5, "priority": 7}]}


def test_higher_priority_takes_over_and_gives_back_when_silent():
    holding = read_holding(FILE, "mux.yaml")
    safety, teleop, _ = holding.subscribers
    assert holding.active == "idle" and holding.output == "output/cmd_vel"
    assert holding.take(teleop, 1.0) and holding.active == "teleop"
    assert holding.take(safety, 1.1) and holding.active == "safety"
    assert not holding.take(teleop, 1.2)
    assert holding.take(teleop, 1.4) and holding.active == "teleop"
    holding.let_go(2.0)
    assert holding.active == "idle"


def test_of_equals_the_first_holds():
    holding = read_holding(FILE, "mux.yaml")
    _, teleop, other = holding.subscribers
    assert holding.take(teleop, 1.0) and not holding.take(other, 1.1)


@pytest.mark.parametrize("file, said", [
    (None, "mux.yaml has no list 'subscribers'"),
    ({"subscribers": [{"name": "a"}]}, r"subscribers\[0\] has no topic"),
    ({"subscribers": [{"name": "a", "topic": "b", "timeout": "x", "priority": 1}]}, "as numbers")])
def test_files_that_cannot_be_used(file, said):
    with pytest.raises(BadFile, match=said):
        read_holding(file, "mux.yaml")


def test_a_clock_that_goes_back_frees_the_robot():
    holding = read_holding(FILE, "mux.yaml")
    safety, teleop, _ = holding.subscribers
    assert holding.take(safety, 100.0)
    assert holding.take(teleop, 1.0) and holding.active == "teleop"
