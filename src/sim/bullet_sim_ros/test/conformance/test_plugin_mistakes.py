"""Numbers, words and names in plugins that cannot be meant: one line names the tag or the name."""

import logging

import pytest

LINKS = """<link name="a"/><link name="b"><pose>0 0 1 0 0 0</pose></link>
  <joint name="j" type="revolute"><parent>a</parent><child>b</child></joint>"""


def robot(plugin: str, tags: str, name: str = "bot") -> str:
    """Two links and a joint, and a plugin in the model."""
    return (f'<model name="{name}">{LINKS}<plugin name="p" filename="{plugin}">{tags}</plugin>'
            "</model>")


@pytest.mark.parametrize("plugin, tag, more", [
    ("libgazebo_grasp_plugin.so", "max_grip_count", ""),
    ("libgazebo_grasp_fix.so", "forces_angle_tolerance", ""),
    ("libgazebo_ros_control.so", "controlPeriod", ""),
    ("libhector_gazebo_ros_magnetic.so", "inclination", ""),
    ("libhector_gazebo_ros_magnetic.so", "magnitude", ""),
    ("libgazebo_ros_p3d.so", "updateRate", "<bodyName>a</bodyName><topicName>t</topicName>"),
])
def test_a_number_that_is_none(bench, caplog, plugin, tag, more):
    # conforms: libgazebo_grasp_plugin.so/max_grip_count, libgazebo_ros_control.so/controlPeriod
    # conforms: libhector_gazebo_ros_magnetic.so/inclination, libgazebo_ros_p3d.so/updateRate
    for word, why in (("inf", "not finite"), ("-inf", "not finite"), ("nan", "not a number"),
                      ("m1", "not a number"), (",5", "not a number"), ("ten", "not a number")):
        caplog.clear()
        bench.spawn(robot(plugin, f"{more}<{tag}>{word}</{tag}>"))
        said = [record.message for record in caplog.records if record.levelname == "ERROR"]
        assert said == [f"model bot: plugin p ({plugin}) is not loaded: <{tag}> is {word!r}, "
                        f"which is {why}"]
        bench.delete("bot")


def test_a_vector_that_is_none(bench, caplog):
    # conforms: libgazebo_ros_p3d.so/xyzOffset
    for word in ("nan 0 0", "inf 0 0", "a b c"):
        caplog.clear()
        bench.spawn(robot("libgazebo_ros_p3d.so", "<bodyName>a</bodyName><topicName>t</topicName>"
                          f"<xyzOffset>{word}</xyzOffset>"))
        assert f"<xyzOffset> is '{word}', which is not three finite numbers" in caplog.text
        bench.delete("bot")


@pytest.mark.parametrize("text, used", [
    ("0.0 0.0 0.0", 0.0), ("0.25 7", 0.25), ("1.5f", 1.5), ("1,5", 1.0), ("0x10", 0.0),
    (" -2e-1m ", -0.2), ("1_0", 1.0), (".5s", 0.5)])
def test_more_than_a_number_is_read_as_far_as_it_goes(bench, caplog, text, used):
    # conforms: libhector_gazebo_ros_magnetic.so/inclination
    bench.spawn(robot("libhector_gazebo_ros_magnetic.so",
                      f"<bodyName>a</bodyName><inclination>{text}</inclination>"))
    said = [record.message for record in caplog.records if record.levelname in ("WARNING", "ERROR")]
    assert said == [f"model bot: plugin p: <inclination> is {text.strip()!r}; {used:g} is used, as "
                    "Gazebo reads it"]
    assert "/magnetic" in bench.advertised()


def test_more_than_three_numbers_and_more_than_a_flag(bench, caplog):
    # conforms: libgazebo_ros_p3d.so/xyzOffset
    bench.spawn(robot("libgazebo_ros_p3d.so", "<bodyName>a</bodyName><topicName>t</topicName>"
                      "<xyzOffset>1 2 3 4</xyzOffset>"))
    truth = bench.listen("/t")
    bench.run(0.01)
    assert truth[-1].pose.pose.position.x == pytest.approx(1.0)
    bench.spawn(robot("libhector_gazebo_ros_magnetic.so", "<bodyName>a</bodyName>"
                      "<useMagneticFieldMsgs> True  false</useMagneticFieldMsgs>", "flagged"))
    assert bench.advertised()["/magnetic"]._type == "sensor_msgs/MagneticField"
    said = [record.message for record in caplog.records if record.levelname == "WARNING"]
    assert [line.split(" is used")[0] for line in said] == [
        "model bot: plugin p: <xyzOffset> is '1 2 3 4'; 1 2 3",
        "model flagged: plugin p: <useMagneticFieldMsgs> is 'true  false'; true"]


def test_the_longest_control_period(bench, caplog):
    # conforms: libgazebo_ros_control.so/controlPeriod
    bench.spawn(robot("libgazebo_ros_control.so", "<controlPeriod>1e308</controlPeriod>"))
    assert "is not loaded" not in caplog.text
    bench.delete("bot")  # it waits for a URDF no more


@pytest.mark.parametrize("names, there_are, used", [
    (("rope", "rail"), "rope, rail", "rope"),
    (("", ""), "joints without a name", "the first joint"),
    (("", "rail"), "rail", "the first joint")])
def test_a_harness_with_a_wrong_word(bench, caplog, names, there_are, used):
    # conforms: libgazebo_ros_harness.so/detach, libgazebo_ros_harness.so/joint
    joints = "".join(f'<joint{f" name={name!r}" if name else ""} type="prismatic">'
                     "<parent>world</parent><child>a</child><axis><xyz>0 0 1</xyz></axis></joint>"
                     for name in names)
    bench.spawn(robot("libgazebo_ros_harness.so", f"{joints}<detach>chain</detach>"))
    assert f"<detach> is 'chain'; there are: {there_are}; {used} is used" in caplog.text
    bench.delete("bot")
    bench.spawn(robot("libgazebo_ros_harness.so", f"{joints}".replace("0 0 1", "0 nan 1")))
    assert "<axis><xyz> is '0 nan 1', which is not three finite numbers" in caplog.text


def test_a_link_is_not_attached_to_itself(make_bench, caplog):
    # conforms: libgazebo_ros_link_attacher.so
    bench = make_bench("""<sdf version="1.6"><world name="w">
      <plugin name="ties" filename="libgazebo_ros_link_attacher.so"/></world></sdf>""")
    bench.spawn(f'<model name="bot">{LINKS}</model>')
    assert not bench.call("/link_attacher_node/attach", model_name_1="bot", link_name_1="a",
                          model_name_2="bot", link_name_2="a").ok
    assert "cannot attach: bot::a is one link; it takes two" in caplog.text
    assert bench.call("/link_attacher_node/attach", model_name_1="bot", link_name_1="a",
                      model_name_2="bot", link_name_2="b").ok
    bench.delete("bot")
    assert not bench.world.models


def test_what_ros_control_says_until_it_is_there(bench, caplog):
    # conforms: libgazebo_ros_control.so, libgazebo_ros_control.so/robotNamespace
    # conforms: libgazebo_ros_control.so/robotParam
    bench.graph.parameters["/arm/urdf"] = "<robot name='r'><link name='a'/></robot>"
    tags = "<robotNamespace>/arm</robotNamespace><robotParam>urdf</robotParam>"
    with caplog.at_level(logging.INFO):
        bench.spawn(robot("libgazebo_ros_control.so", tags))
    assert [record.getMessage() for record in caplog.records if record.levelname == "INFO"] == [
        "Loading gazebo_ros_control plugin",
        "Starting gazebo_ros_control plugin in namespace: /arm",
        "gazebo_ros_control plugin is waiting for model URDF in parameter [/arm/urdf] on the ROS "
        "param server.",
        "Loaded gazebo_ros_control."]
    assert bench.call("/arm/controller_manager/switch_controller", strictness=0).ok
    assert "you need to specify a strictness level of" in caplog.records[-1].getMessage()
