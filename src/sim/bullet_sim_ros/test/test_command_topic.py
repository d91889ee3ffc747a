"""Controllers' parameters from the server, and what their topic `command` refuses and says."""

import logging
from types import SimpleNamespace

import pytest
from std_msgs.msg import Float64, Float64MultiArray

from bullet_sim.control.controllers.commands import Commands
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.errors import PluginError
from bullet_sim_ros import params
from bullet_sim_ros.control import (
    controllers,  # noqa: F401  (they register)
    registry,
)
from bullet_sim_ros.control.controllers import command_topic


class PluginContext:
    """A controller's host without ROS: it keeps what the controller would do with a message."""

    def __init__(self, name="/r/c", **values):
        self.name, self.parameters = name, ControllerParameters(name, values)

    def describe(self):
        return f"controller {self.name}"

    def subscribe(self, _topic, _kind, take, **_options):
        self.take = take


@pytest.fixture
def clock(monkeypatch):
    """The wall's clock, to be set."""
    now = SimpleNamespace(value=1000.0)
    monkeypatch.setattr("time.monotonic", lambda: now.value)
    return now


def test_a_flood_of_bad_commands_is_one_line_in_ten_seconds(clock, caplog):
    one, all_joints = PluginContext("/r/one"), PluginContext("/r/all")
    command_topic.subscribe_one(one, Commands())
    command_topic.subscribe_all(all_joints, Commands(), 2)
    with caplog.at_level(logging.WARNING, "bullet_sim.control"):
        for clock.value in (1000.0, 1000.1, 1009.9, 1010.1, 1019.0):
            assert one.take(Float64(float("nan"))) is None
            assert all_joints.take(Float64MultiArray(data=[1.0])) is None
    said = [record.getMessage() for record in caplog.records]
    assert [line.split()[1] for line in said] == 2 * ["/r/one:", "/r/all:"]
    assert "not finite" in said[0]
    assert "does not match number of joints (2)" in said[1]


def test_a_good_command_among_bad_ones_is_taken(clock):
    context, commands = PluginContext(), Commands()
    command_topic.subscribe_one(context, commands)
    context.take(Float64(float("inf")))
    context.take(Float64(1.5))()
    assert commands.at(0.0) == (1.5,)


def test_a_negative_time_out_is_an_error_that_names_the_parameter():
    assert command_topic.command_timeout(PluginContext()) == 0.0
    assert command_topic.command_timeout(PluginContext(command_timeout=0.2)) == 0.2
    with pytest.raises(PluginError, match=r"/r/c/command_timeout is -0\.2, .*not negative"):
        command_topic.command_timeout(PluginContext(command_timeout=-0.2))


def test_who_did_not_load_the_file_is_told_how(monkeypatch):
    monkeypatch.setattr(params, "below", {"/r/c": {"joint": "a"}}.get)
    p = params.of_controllers("/r/c")
    assert p.text("joint") == "a"
    for read, above in ((lambda: p.number("pid/d"), "/r"),
                        (lambda: p.group("pid").number("d"), "/r/c"),
                        (lambda: params.of_controllers("/c").text("joint"), "/")):
        with pytest.raises(PluginError, match=rf"is not set; was the controller's YAML file loaded "
                                              rf"there \(rosparam load FILE {above}\)\?$"):
            read()


def test_every_registered_type_has_what_a_controller_needs():
    assert len(registry.types()) >= 11
    for kind in registry.types():
        made = registry.find(kind)
        assert issubclass(made, registry.Controller), kind
        assert made.__doc__, kind
    assert registry.hint("effort_controllers/JointPositonController") == (
        " (did you mean effort_controllers/JointPositionController?)")
