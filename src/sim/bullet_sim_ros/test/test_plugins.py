"""The plugin registry and how plugins read their tags, without a master."""

import logging
from xml.etree.ElementTree import fromstring

import pytest

from bullet_sim.description import (
    LinkDescription,
    ModelDescription,
    PluginDescription,
    SensorDescription,
)
from bullet_sim.errors import PluginError
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim.world import World
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.plugin_host import registry
from bullet_sim_ros.plugin_host.context import PluginHost
from bullet_sim_ros.plugin_host.registry import load_plugins, plugin
from bullet_sim_ros.plugins import register_plugins
from bullet_sim_ros.scheduler import Scheduler
from bullet_sim_ros.services.models import with_namespace

register_plugins()


def described(filename: str = "libx.so", body: str = "") -> PluginDescription:
    return PluginDescription("p", filename, fromstring(f"<plugin>{body}</plugin>"))


def parameters(body: str) -> PluginParameters:
    return PluginParameters("robot", described(body=body))


def test_values_are_trimmed_and_typed():
    p = parameters("<a> x </a><n> 2.5 </n><v>1 -2 3</v><t>TRUE</t><z>0</z><e/>")
    assert p.text("a") == "x"
    assert p.number("n", 0.0) == 2.5
    assert p.vector("v") == (1.0, -2.0, 3.0)
    assert p.flag("t", False) is True
    assert p.flag("z", True) is False
    assert (p.text("e", "d"), p.number("missing", 7.0), p.vector("none")) == ("d", 7.0, (0, 0, 0))


def test_a_bad_flag_warns_and_a_bad_number_is_an_error(caplog):
    p = parameters("<f>maybe</f><n>fast</n><v>a b c</v>")
    with caplog.at_level(logging.WARNING):
        assert p.flag("f", True) is True
    assert "<f> is 'maybe', neither true nor false" in caplog.text
    for read in (lambda: p.number("n", 0.0), lambda: p.vector("v"), lambda: p.required("x")):
        with pytest.raises(PluginError, match=r"<[nvx]>"):
            read()


def test_the_first_numbers_count_whatever_was_meant(caplog):
    p = parameters("<n>0 1 2</n><few>1 2</few><many>1 2 3 4</many><cut>1 2m 3</cut><one>5</one>")
    assert p.number("n", 9.0) == p.number("n", 9.0) == 0.0
    assert p.vector("few") == p.vector("cut") == (1.0, 2.0, 0.0)
    assert p.vector("many") == (1.0, 2.0, 3.0)
    assert p.numbers("few", (0, 0, 0), one_for_all=True) == (1.0, 1.0, 1.0)
    assert p.numbers("one", (0, 0, 0), one_for_all=True) == (5.0, 5.0, 5.0)
    assert [line.partition("plugin p: ")[2] for line in caplog.messages] == [
        "<n> is '0 1 2'; 0 is used, as Gazebo reads it",
        "<few> is '1 2'; 1 2 0 is used, as Gazebo reads it",
        "<cut> is '1 2m 3'; 1 2 0 is used, as Gazebo reads it",
        "<many> is '1 2 3 4'; 1 2 3 is used, as Gazebo reads it"]


@pytest.mark.parametrize("body, found", [
    ("", "missing"), ("<robotNamespace/>", "empty"), ("<robotNamespace>/</robotNamespace>", "/")])
def test_namespace_tells_absent_from_empty(body, found):
    assert parameters(body).namespace(missing="missing", empty="empty") == found


@pytest.fixture
def world():
    made = World()
    yield made
    made.close()


def load(world, *plugins, sensor: SensorDescription | None = None):
    link = LinkDescription("link", sensors=(sensor,) if sensor else ())
    model = world.spawn(ModelDescription("robot", static=True, links=(link,), plugins=plugins))
    scheduler = Scheduler(world)
    shared = PluginHost(world, None, scheduler, None, Lockstep("", 0.0, Mailbox()))
    return load_plugins(shared, model), scheduler


def test_an_unknown_plugin_is_one_warning_that_names_it_and_its_model(world, caplog):
    sensor = SensorDescription("eye", "camera", plugins=(described("libnothing_at_all.so"),))
    with caplog.at_level(logging.WARNING):
        assert load(world, described("libgazebo_ros_diff_driv.so"), sensor=sensor)[0] == []
    first, second = [record.getMessage() for record in caplog.records]
    assert "model robot: plugin p (libgazebo_ros_diff_driv.so) is not known" in first
    assert "did you mean libgazebo_ros_diff_drive.so?" in first
    assert "model robot: sensor eye: plugin p (libnothing_at_all.so) is not known" in second


@pytest.fixture
def good(monkeypatch):
    """A plugin of the test's own, under libgood.so."""
    monkeypatch.setattr(registry, "_registry", dict(registry._registry))

    @plugin("libgood.so")
    class Good:
        def __init__(self, context):
            self.broken = context.parameters.has("broken")
            (context.each_step if context.parameters.has("stepwise") else self.fast(context))(
                self.update
            )
            context.on_reset(self.update)

        @staticmethod
        def fast(context):
            return lambda action: context.every(1000.0, action)

        def update(self):
            if self.broken:
                raise ZeroDivisionError("division by zero")
    return Good


@pytest.mark.parametrize("filename, body, said", [
    ("libgazebo_ros_diff_drive.so", "<leftJoint>nope</leftJoint>",
     "no joint of model robot named 'nope'; there are: none"),
    ("libgazebo_ros_laser.so", "", "it belongs inside a <sensor>"),
    ("libgazebo_ros_camera.so", "", "it belongs inside a <sensor>"),
    ("libgazebo_ros_imu.so", "", "it needs a <bodyName>"),
    ("libgazebo_ros_imu.so", "<bodyName>link</bodyName><gaussianNoise>-1</gaussianNoise>",
     "<gaussianNoise> is -1.0, and a deviation is not negative"),
    ("libgazebo_ros_p3d.so", "<bodyName>nope</bodyName>", "no link of model robot named 'nope'"),
    ("libgazebo_ros_p3d.so", "<bodyName>link</bodyName>", "it needs a <topicName>"),
])
def test_a_plugin_that_cannot_load_is_one_error_and_the_others_load(
        world, caplog, good, filename, body, said):
    with caplog.at_level(logging.WARNING):
        loaded, _ = load(world, described(filename, body), described("libgood.so"))
    assert len(loaded) == 1
    errors = [record for record in caplog.records if record.levelno >= logging.ERROR]
    assert len(errors) == 1
    assert f"({filename}) is not loaded: {said}" in errors[0].getMessage()


@pytest.mark.parametrize("body", ["<broken/>", "<broken/><stepwise/>"])
def test_a_plugin_that_fails_at_work_is_switched_off_with_one_error(world, caplog, good, body):
    (broken, sound), scheduler = load(world, described("libgood.so", body), described("libgood.so"))
    with caplog.at_level(logging.ERROR):
        for _ in range(5):
            world.step(scheduler.next_tick() - world.tick)
            scheduler.run()
        for context in (broken, sound):
            context.reset()
    assert [record.getMessage() for record in caplog.records] == [
        "model robot: plugin p (libgood.so) failed and is switched off: "
        "ZeroDivisionError: division by zero"]
    assert sound.updates == 5


def test_the_namespace_is_injected_where_there_is_none():
    sensor = SensorDescription("s", "ray", plugins=(described(),))
    own = described(body="<robotNamespace>mine</robotNamespace>")
    model = ModelDescription("m", plugins=(described(), own),
                             links=(LinkDescription("l", sensors=(sensor,)),))
    named = with_namespace(model, "/tb3_0/")
    assert [p.element.findtext("robotNamespace") for p in named.plugins] == ["/tb3_0/", "mine"]
    inner = named.links[0].sensors[0].plugins[0]
    assert inner.element.findtext("robotNamespace") == "/tb3_0/"
    assert model.plugins[0].element.find("robotNamespace") is None
