"""A node says once that nobody listens to its commands; the master answers as the test says."""

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from python_amendments import unheard

SRC = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize(("name", "kind", "program", "line"), [
    ("/turtle1/cmd_vel", unheard.TWIST, "learning_topic/scripts/velocity_publisher.py",
     "yet. Type in another terminal: rosrun turtlesim turtlesim_node; this"),
    ("/turtle2/cmd_vel", unheard.TWIST, "turtle2",
     "yet. Type in another terminal: rosservice call /spawn 2 2 0 turtle2; this"),
    ("/motor_output", unheard.TWIST, "car_control/scripts/keyboard_control.py",
     "yet. Type in another terminal: roslaunch racecar_description car_control.launch "
     "keyboard:=false; this"),
    ("/cmd_vel", unheard.TWIST, "turtlebot3_teleop/nodes/turtlebot3_teleop_key",
     "yet. Type in another terminal: roslaunch turtlebot3_gazebo turtlebot3_world.launch; this"),
    ("/racecar/left_controller/command", "std_msgs/Float64", "car_control/scripts/motor_control.py",
     "yet. Type in another terminal: roslaunch racecar_description car_control.launch; this"),
    ("/car/cmd_vel", unheard.TWIST, "heard", "")])
def test_commands_that_nobody_listens_to(said, monkeypatch, name, kind, program, line):
    listened = {"turtle2": ["/turtle1/cmd_vel"], "heard": ["/car/cmd_vel"]}.get(program, [])
    answers = {"getSystemState": [[], [[each, ["/node"]] for each in listened], []],
               "getTopicTypes": [[each, unheard.TWIST] for each in listened]}
    monkeypatch.setattr(unheard, "asked", answers.get)
    monkeypatch.setattr(sys, "argv", [str(SRC / program)])
    unheard.tell_of_unheard(name, kind)
    assert [each.startswith(f"Nobody listens to {name} {line}") for each in said] == (
        [True] if line else [])


@pytest.mark.parametrize(("kind", "connected", "sees", "looked"), [
    (unheard.TWIST, False, True, 1), (unheard.TWIST, True, True, 0),
    (unheard.TWIST, False, False, 0), ("std_msgs/String", False, True, 0)])
def test_who_drives_by_what_it_sees_misses_that_first(monkeypatch, kind, connected, sees, looked):
    class Publisher:
        closed = False

        def __init__(self, name, kind):
            self.resolved_name, self.type = name, kind

        def has_connections(self):
            return connected

    image = SimpleNamespace(type="sensor_msgs/Image", has_connections=lambda: sees)
    found = []
    monkeypatch.setattr(unheard, "says_it_itself", lambda: False)
    monkeypatch.setattr(unheard, "after_grace", lambda look, publisher: look(publisher))
    monkeypatch.setattr(unheard, "tell_of_unheard", lambda *what: found.append(what))
    unheard.amend_publishers(SimpleNamespace(
        _PublisherImpl=Publisher, get_topic_manager=lambda: SimpleNamespace(subs={"/i": image})))
    Publisher("/cmd_vel", kind)
    assert len(found) == looked
