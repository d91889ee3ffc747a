"""A plugin's tag that nothing reads is one warning, with the nearest tag that there is."""

import pytest

PLUGIN = """<model name="bot"><link name="a"/>
  <plugin name="p" filename="{}">{}</plugin></model>"""
P3D = "<bodyName>a</bodyName><topicName>t</topicName>"
BUMPER = """<model name="bot"><link name="a"><collision name="c"><geometry><sphere>
  <radius>1</radius></sphere></geometry></collision><sensor name="s" type="contact">
  <contact><collision>c</collision></contact>
  <plugin name="p" filename="libgazebo_ros_bumper.so">{}</plugin></sensor></link></model>"""


def warnings(caplog) -> list[str]:
    """All lines from warnings up."""
    return [record.getMessage() for record in caplog.records if record.levelname != "INFO"]


def test_a_mistyped_tag_is_one_warning_with_a_hint(bench, caplog):
    # conforms: unknown tag
    bench.spawn(PLUGIN.format("libgazebo_ros_p3d.so", P3D + "<updaterate>5</updaterate>"))
    assert warnings(caplog) == [
        "model bot: plugin p (libgazebo_ros_p3d.so): <updaterate> is ignored, as by Gazebo: the "
        "plugin has no such tag (did you mean <updateRate>?)"]
    poses = bench.listen("/t")
    bench.run(0.01)
    assert len(poses) == 10  # the default rate: the plugin works


def test_each_such_tag_is_named_once(bench, caplog):
    # conforms: unknown tag
    twice = "<colour>red</colour><frameNam>x</frameNam><colour>blue</colour>"
    bench.spawn(PLUGIN.format("libgazebo_ros_p3d.so", P3D + twice))
    lines = warnings(caplog)
    assert ["<colour>" in line for line in lines] == [True, False]
    assert not lines[0].endswith("?)") and lines[1].endswith("(did you mean <frameName>?)")


@pytest.mark.parametrize("model", [
    PLUGIN.format("libgazebo_ros_p3d.so", P3D + "<alwaysOn>true</alwaysOn><visualize>0</visualize>"
                  "<always_on>1</always_on><update_rate>5</update_rate>"),
    # without effect in Gazebo, too, and in the table
    PLUGIN.format("libgazebo_ros_f3d.so", P3D + "<frameName>x</frameName>"),
    BUMPER.format("<alwaysOn>true</alwaysOn><updateRate>5</updateRate>"),
    # some of it read only when the robot's description has come
    PLUGIN.format("libgazebo_ros_control.so", "<legacyModeNS>true</legacyModeNS>"
                  "<eStopTopic>stop</eStopTopic>"),
    # children that are more than a single value
    PLUGIN.format("libgazebo_ros_harness.so", '<joint name="j"><child>a</child></joint>'
                  "<detach>j</detach><winch><joint>j</joint></winch>"),
    PLUGIN.format("libgazebo_ros_harness.so", '<joint name="j"><child>a</child></joint><detach>j'
                  "</detach><winch><joint>j</joint><pos_pid><p>1</p></pos_pid></winch>"),
    # a plugin that reads nothing
    PLUGIN.format("libgazebo_ros_template.so", "<updateRate>3</updateRate>"),
])
def test_tags_that_public_robots_carry_are_no_warning(bench, caplog, model):
    # conforms: unknown tag
    bench.spawn(model, namespace="/bot_1")
    assert warnings(caplog) == []
    bench.delete("bot")  # ends the thread that waits for the robot's description


def test_a_plugin_that_cannot_load_says_only_that(bench, caplog):
    # conforms: unknown tag
    bench.spawn(PLUGIN.format("libgazebo_ros_p3d.so", "<bodyname>a</bodyname>"))
    assert warnings(caplog) == ["model bot: plugin p (libgazebo_ros_p3d.so) is not loaded: it "
                                "needs a <bodyName>"]


HARNESS = """<joint name="j"><child>a</child></joint><detach>j</detach><winch><joint>j</joint>
  <pos_pd><p>1</p></pos_pd></winch>"""
ARMS = """<arm><palm_link>a</palm_link><gripper_link>a</gripper_link><arm_nam>x</arm_nam></arm>
  <arm><palm_link>a</palm_link><gripper_link>a</gripper_link><arm_nam>y</arm_nam></arm>"""


@pytest.mark.parametrize("library, tags, named", [
    ("libgazebo_ros_harness.so", HARNESS, ("<winch><pos_pd>", "<winch><pos_pid>")),
    ("libgazebo_grasp_fix.so", ARMS, ("<arm><arm_nam>", "<arm><arm_name>"))])
def test_so_is_one_within_a_plugins_element(bench, caplog, library, tags, named):
    # conforms: unknown tag
    bench.spawn(PLUGIN.format(library, tags))
    (line,) = warnings(caplog)
    assert f"{named[0]} is ignored" in line and line.endswith(f"(did you mean {named[1]}?)")
