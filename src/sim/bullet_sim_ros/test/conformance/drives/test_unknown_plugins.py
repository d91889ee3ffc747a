"""Plugins in the world, and those that are not known: one warning, and the rest goes on."""

import logging

import pytest
from gazebo_msgs.msg import ModelStates

WORLD = """<sdf version="1.6"><world name="town">{}<model name="box"><static>true</static>
  <link name="l"/></model></world></sdf>"""


def warnings(caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.levelno == logging.WARNING]


@pytest.mark.parametrize("text, said", [
    ('<link name="l"><sensor name="eye" type="camera"><plugin name="p" filename="libx.so"/>'
     "</sensor></link>",
     "model box: sensor eye: plugin p (libx.so) is not known here and left out; sensor: its topics "
     "will be missing"),
    ('<link name="l"/><plugin name="p" filename="libx.so"/>',
     "model box: plugin p (libx.so) is not known here and left out; actuator or model plugin: what "
     "it moves will stand still, its topics will be missing"),
    ('<link name="l"/><plugin name="p" filename="libLiftDragPlugin.so"/>',
     "model box: plugin p (libLiftDragPlugin.so) is not known here and left out; physics: no lift "
     "and no drag; what flies or sails by them will not"),
    ('<link name="l"><visual name="v"><geometry><sphere><radius>1</radius></sphere></geometry>'
     '<plugin name="p" filename="libx.so"/></visual></link>',
     "looks: what it shows will be missing"),
])
def test_a_warning_says_what_will_be_missing(bench, caplog, text, said):
    # conforms: unknown plugins
    bench.spawn(f'<model name="box">{text}</model>')
    found = [line for line in warnings(caplog) if "is not known here" in line]
    assert len(found) == 1
    assert said in found[0]


def test_each_file_name_is_told_once_for_a_model(bench, caplog):
    # conforms: unknown plugins
    three = '<plugin name="p" filename="libx.so"/>' * 3 + '<plugin name="p" filename="liby.so"/>'
    for _ in range(2):
        bench.spawn(f'<model name="box"><link name="l"/>{three}</model>')
        bench.delete("box")
    assert len(warnings(caplog)) == 2
    bench.spawn(f'<model name="other"><link name="l"/>{three}</model>')
    assert len(warnings(caplog)) == 4


def test_plugins_of_the_world_are_loaded_or_told(make_bench, caplog):
    # conforms: unknown plugins, sdf world/plugin
    bench = make_bench(WORLD.format(
        '<plugin name="w" filename="libx.so"/>'
        '<plugin name="t" filename="libgazebo_ros_template.so"/>'
        '<plugin name="d" filename="libgazebo_ros_diff_drive.so"/>'
        '<plugin name="a" filename="/opt/ros/lib/libgazebo_ros_api_plugin.so"/>'))
    lines = [record.getMessage() for record in caplog.records]
    assert lines == [
        "world town: plugin w (libx.so) is not known here and left out; world plugin: what it "
        "does to the world will be missing, models are not touched",
        "world town: plugin d (libgazebo_ros_diff_drive.so) is not loaded: it belongs inside a "
        "<model>, not in the world"]
    states = bench.listen("/gazebo/model_states")
    bench.run(0.1)
    assert isinstance(states[-1], ModelStates)


def test_a_name_that_is_nearly_right_gets_a_hint(bench, caplog):
    # conforms: unknown plugins
    bench.spawn('<model name="box"><link name="l"/>'
                '<plugin name="p" filename="libgazebo_ros_diff_driv.so"/></model>')
    assert "did you mean libgazebo_ros_diff_drive.so?" in caplog.text
