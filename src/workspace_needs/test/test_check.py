"""rosrun bullet_sim_ros check: what it finds, how it says so, and its exit code."""

import os
import threading
import time
from pathlib import Path

import pytest
import rospy
from robot_texts import DRIVE, JOINTED, LAUNCH, ROBOT, WORLD
from workspace_needs.check import contents
from workspace_needs.check.command import main
from workspace_needs.check.texts import TextChecker

from bullet_sim.formats.xacro.bounds import run_bounded
from bullet_sim_ros.interface import WORKS, documented
from bullet_sim_ros.package_paths import open_resources

# A file is checked in a fork of this process, which must not hold engines or OpenGL of other tests.
pytestmark = pytest.mark.processes


def test_a_robot_that_works(check):
    code, said = check("robot.urdf", ROBOT.format(""))
    assert code == 0
    assert "works         model r (1 links, 0 joints)" in said
    assert said.endswith("all of it will work\n")


@pytest.mark.parametrize("where, matters", [
    ('<gazebo><plugin name="p" filename="libmy_own.so"/></gazebo>',
     "actuator or model plugin: what it moves will stand still, its topics will be missing"),
    ('<gazebo reference="base"><sensor name="s" type="ray"><plugin name="p" '
     'filename="libmy_own.so"/></sensor></gazebo>', "sensor: its topics will be missing"),
])
def test_an_unknown_plugin_is_named_with_what_is_lost(check, where, matters):
    code, said = check("robot.urdf", ROBOT.format(where))
    assert code == 1
    assert f"NOT THERE     plugin p (libmy_own.so): not known here: {matters}" in said


def test_a_known_plugin_works_and_a_tag_it_has_not_is_told(check):
    plugin = """<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so">
      <bodyName>base</bodyName><topicName>t</topicName><framName>1</framName></plugin></gazebo>"""
    code, said = check("robot.urdf", ROBOT.format(plugin))
    assert code == 0
    assert "works         plugin p (libgazebo_ros_p3d.so)" in said
    assert ("(libgazebo_ros_p3d.so): <framName> is ignored, as by Gazebo: the plugin has no such "
            "tag (did you mean <frameName>?)") in said


def test_a_missing_mesh_and_broken_xml_are_problems(check):
    robot = ROBOT.format("").replace('<box size="1 1 1"/>',
                                     '<mesh filename="package://bullet_sim_ros/no.stl"/>')
    code, said = check("robot.urdf", robot)
    assert code == 1 and "PROBLEM" in said and "no.stl" in said
    code, said = check("robot.urdf", ROBOT.format("")[:-9])
    assert code == 1 and "PROBLEM       robot:" in said


CAMERA = """<gazebo {}><plugin name="eye" filename="libgazebo_ros_camera.so">
  <cameraName>eye</cameraName></plugin></gazebo>"""


SENSOR = """<gazebo reference="base"><sensor name="s" type="{}"><camera><image>
  <width>8</width><height>8</height><format>{}</format></image></camera>
  <plugin name="eye" filename="libgazebo_ros_camera.so"><cameraName>eye</cameraName></plugin>
  </sensor></gazebo>"""


CONTROL = """<gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>"""


@pytest.mark.parametrize("wrong, right, why", [
    (DRIVE.format(tag="leftJont"), DRIVE.format(tag="leftJoint"), ") is not loaded: no joint"),
    (CAMERA.format(""), SENSOR.format("camera", "R8G8B8"), ") is not loaded: it belongs"),
    (SENSOR.format("camera", "RGB9"), SENSOR.format("camera", "L8"), "ImageFormat RGB9"),
    (SENSOR.format("camra", "L8"), SENSOR.format("camera", "L8"), "there is no type 'camra'"),
    ('<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"/></gazebo>',
     '<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"><bodyName>base</bodyName>'
     "<topicName>t</topicName></plugin></gazebo>", "it needs a <bodyName>"),
    ('<gazebo><plugin name="p"/></gazebo>', CONTROL, "plugin p: it has no filename"),
])
def test_a_plugin_that_will_not_be_loaded_is_a_problem(check, wrong, right, why):
    code, said = check("robot.urdf", JOINTED.format(wrong))
    assert code == 1
    assert [line for line in said.splitlines() if line.startswith("  PROBLEM") and why in line]
    assert not ("is not loaded" in said and "works         plugin" in said)
    assert check("robot.urdf", JOINTED.format(right))[0] == 0


def test_what_a_plugin_only_remarks_does_not_count(check):
    drive = DRIVE.format(tag="leftJoint")
    code, said = check("robot.urdf", JOINTED.format(drive), "--all")
    assert code == 0 and "it says" not in said  # which tags are left to their defaults
    code, said = check("robot.urdf", JOINTED.format(CONTROL))
    assert code == 0 and "approximated  it says: " in said and "no usable <transmission>" in said
    arm = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
      <joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
      <actuator name="a"/>
      </transmission>"""
    code, said = check("robot.urdf", JOINTED.format(CONTROL + arm))
    assert code == 0 and "approximated  it says: Deprecated syntax" in said


def test_no_master_and_no_thread_is_left(check):
    before = rospy.Publisher, rospy.get_param, rospy.names._caller_id
    text = JOINTED.format(CONTROL.replace("/>", "><robotParam>later</robotParam></plugin>"))
    assert check("robot.urdf", text)[0] == 0
    assert (rospy.Publisher, rospy.get_param, rospy.names._caller_id) == before
    for waiting in [thread for thread in threading.enumerate() if thread.name == "urdf"]:
        waiting.join(60)
        assert not waiting.is_alive()


def test_it_looks_into_what_a_world_includes(check, tmp_path, monkeypatch):
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "model.sdf").write_text("""<sdf version="1.6"><model name="m">
      <link name="l"/><plugin name="p" filename="libmy_own.so"/></model></sdf>""")
    (tmp_path / "pair").mkdir()
    (tmp_path / "pair" / "model.sdf").write_text("""<sdf version="1.6"><model name="two">
      <link name="l"/><include><uri>model://robot</uri></include></model></sdf>""")
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(tmp_path))
    for name in ("robot", "pair"):
        code, said = check("a.world", WORLD.format(f"<include><uri>model://{name}</uri></include>"))
        assert code == 1
        assert "a.world, included model://robot\n  NOT THERE     plugin p (libmy_own.so)" in said


def test_a_light_and_plugins_that_do_not_matter_here(check):
    light = '<light name="l" type="{}"/>'
    code, said = check("a.world", WORLD.format(light.format("sunny")))
    assert code == 1 and "PROBLEM       light l: there is no type 'sunny'; there are point" in said
    assert check("a.world", WORLD.format(light.format("spot")))[0] == 0
    gui = """<gui><plugin name="g" filename="libmy_window.so"/></gui>
      <plugin name="paths" filename="libgazebo_ros_paths_plugin.so"/>"""
    assert check("a.world", WORLD.format(gui))[0] == 0


def test_a_material_that_is_not_there_is_one_line(check):
    visual = """<visual name="{}"><geometry><sphere><radius>1</radius></sphere></geometry>
      <material><script><uri>model://no_such/materials/scripts</uri>
      <uri>model://no_such/materials/textures</uri><name>{}</name></script></material></visual>"""
    model = '<sdf version="1.6"><model name="m"><link name="l">{}</link></model></sdf>'
    code, said = check("m.sdf", model.format(visual.format("a", "No/Such")
                                             + visual.format("b", "No/Such")))
    assert code == 1 and said.count("PROBLEM") == 1 and "material 'No/Such' not found" in said
    assert check("m.sdf", model.format(visual.format("a", "Gazebo/Grey")))[0] == 0


def test_xacro_is_expanded_with_arguments(check):
    text = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="$(arg n)">
      <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
      </inertial></link></robot>"""
    code, said = check("robot.xacro", text, "n:=arm")
    assert code == 0, said
    code, said = check("robot.xacro", text)
    assert code == 1 and "PROBLEM       robot:" in said


def test_a_world_with_a_model_that_is_not_there(check):
    assert check("a.world", WORLD.format(""))[0] == 0
    code, said = check("a.world", WORLD.format("<include><uri>model://no_such</uri></include>"))
    assert code == 1 and "model://no_such" in said


def test_a_package_is_looked_through(capsys):
    assert main(["learning_topic"]) == 0
    said = capsys.readouterr().out
    assert "course.world" in said and "0course.launch, parameter /robot_description" in said


@pytest.mark.parametrize("name, words", [
    ("strange_arm", "clone its source into src/, or mend the name; once it is cloned, type: "
                    "rosrun bullet_sim_ros check ~/catkin_ws/src/strange_arm"),
    ("my_robot_vision", "scripts of that package are in ai_robot_tracking here"),
    ("mav_msgs", "neither Debian nor this repository has it; clone its source into src/, or mend"),
    ("moveit_commander", "MoveIt is not in Debian"), ("nothere.py", "or give a path")])
def test_what_to_type_for_a_name_that_nobody_has(capsys, name, words):
    assert main([name]) == 2
    said = capsys.readouterr().err
    assert words in said and "did you mean" not in said


def test_nothing_to_check_and_a_wrong_launch_file(capsys):
    assert main(["no_such_package"]) == 2
    assert "check: no_such_package: no such file or package" in capsys.readouterr().err
    assert main(["learning_topic", "0curse.launch"]) == 1
    assert ("not there (did you mean 0course.launch?); there are: 0course.launch"
            in capsys.readouterr().out)
    assert main(["learning_topik"]) == 2
    assert "package (did you mean learning_topic?); try" in capsys.readouterr().err
    assert not Path("no_such_package").exists()


def test_robots_that_are_only_shown(package, capsys):
    shown = '<robot name="r"><link name="base"><visual><geometry><sphere radius="1"/></geometry>' \
            "</visual></link></robot>"
    folder = package(robot__urdf=shown)
    assert main([folder]) == 0
    said = capsys.readouterr().out
    assert "approximated  robot: only to be shown: nothing in it has mass" in said
    assert main([f"{folder}/robot.urdf"]) == 1
    package(broken__urdf=shown.replace("sphere", "cone"))
    assert main([folder]) == 1
    assert "broken.urdf\n  PROBLEM       robot: link 'base' <visual>" in capsys.readouterr().out
    package(broken__urdf=shown)
    package(spawn__launch=LAUNCH.format("robot_description", "gazebo_ros", "spawn_model"))
    assert main([folder]) == 1
    assert "parameter /robot_description\n  PROBLEM       robot: " in capsys.readouterr().out


def test_a_texture_that_is_no_image(check, tmp_path):
    (tmp_path / "a.png").write_text("no image")
    code, said = check("a.world", WORLD.format(
        "<model name='m'><link name='l'><visual name='v'><geometry><box><size>1 1 1</size></box>"
        "</geometry><material><pbr><metal><albedo_map>file://" + str(tmp_path / "a.png")
        + "</albedo_map></metal></pbr></material></visual></link></model>"))
    assert code == 1 and "a.png cannot be read: it is not an image; give a PNG or JPEG" in said


def test_a_name_of_a_million_letters_is_one_short_line(check):
    code, said = check("a.urdf", ROBOT.format("").replace('"r"', f'"{"x" * 1_000_000}"'))
    assert code == 0 and max(map(len, said.splitlines())) < 1000
    assert "(1 links, 0 joints)" in said


def test_an_encoding_that_there_is_not(check):
    code, said = check("a.launch", '<?xml version="1.0" encoding="no-such-code"?><launch/>')
    assert code == 1 and "PROBLEM       launch file: " in said


def test_yaml_of_a_package(package, capsys):
    folder = package(robot__urdf=ROBOT.format(""), opencv__yaml="%YAML:1.0\na: !!opencv-matrix\n",
                     own__yaml="a: !mine {b: 1}\n", good__yaml="a:\n  type: x\n")
    assert main([folder]) == 0
    assert capsys.readouterr().out.endswith("all of it will work\n")
    package(bad__yaml="a:\n\tb: 1\n")
    package(arm__yaml="arm:\n  grip: {type: effort_controllers/JointPositionContrller}\n")
    assert main([folder]) == 1
    said = capsys.readouterr().out
    assert "bad.yaml\n  PROBLEM       YAML: line 2, column 1: found character" in said
    assert "controller /arm/grip (effort_controllers/JointPositionContrller): there is no" in said


@pytest.mark.parametrize("text, said", [
    ("a: &a {b: *a}", "an alias (*) stands within its own anchor (&)"),
    ("[" * 5000, "it is nested too deeply")])
def test_yaml_that_does_not_end(package, capsys, text, said):
    assert main([package(endless__yaml=text)]) == 1
    assert f"endless.yaml\n  PROBLEM       YAML: {said}" in capsys.readouterr().out


def test_yaml_whose_aliases_grow_is_bounded(package, capsys, monkeypatch):
    monkeypatch.setattr("workspace_needs.check.contents.LONGEST", 1.0)
    lines = ["a0: &a0 {x: 1}", *(f"a{n}: &a{n} {{p: *a{n - 1}, q: *a{n - 1}}}"
                                 for n in range(1, 40))]
    assert main([package(laughs__yaml="\n".join(lines))]) == 1
    assert "checking it takes longer than 1 s of processor time" in capsys.readouterr().out


def test_a_hyphen_in_a_name_is_no_fault_where_the_spawner_gives_the_namespace(check):
    robot = JOINTED.format(DRIVE.format(tag="leftJoint")).replace('name="r"', 'name="my-robot"')
    code, said = check("robot.urdf", robot)
    assert code == 0 and "PROBLEM" not in said


def test_time_and_memory_of_a_file_are_bounded(check, monkeypatch):
    row = "".join(f"<model name='m{n}'><pose>{n} 0 0 0 0 0</pose><link name='l'><collision "
                  "name='c'><geometry><box/></geometry></collision></link></model>"
                  for n in range(900))
    monkeypatch.setattr(contents, "LONGEST", 0.5)
    code, said = check("row.world", WORLD.format(row))
    assert code == 1
    assert "row.world: checking it takes longer than 0.5 s of processor time; simplify" in said
    monkeypatch.setattr(contents, "LONGEST", 60.0)
    monkeypatch.setattr(contents, "MOST_BYTES", 2**23)
    code, said = check("row.world", WORLD.format(row))
    assert code == 1 and "row.world: checking it needs more memory than there is" in said


BOX = "<include><uri>model://unit_box</uri><name>b{0}</name>{1}</include>"
LINK = "<link name='l{0}'>{1}</link>"
JOINED = LINK + ("<joint name='j{0}' type='fixed'><parent>world</parent><child>l{0}</child>"
                 "</joint>")
MODEL = f"<model name='m{{0}}'>{{1}}{LINK.format('', '')}</model>"
APART = "<pose>{0}0 0 0 0 0 0</pose>"
SOLID = "<collision name='c'><geometry><sphere/></geometry></collision>"
IN_ONE = "<model name='m'><link name='l'/>{}</model>"


@pytest.mark.parametrize("part, around", [
    (BOX.format("{0}", ""), "{}"), (BOX.format("{0}", "<static>1</static>"), "{}"),
    (MODEL.format("{0}", ""), "{}"), (MODEL.format("{0}", APART), "{}"),
    (MODEL.format("{0}", ""), IN_ONE), (LINK.format("{0}", ""), IN_ONE),
    (LINK.format("{0}", APART + SOLID), IN_ONE), (LINK.format("{0}", SOLID), IN_ONE),
    (LINK.format("{0}", SOLID), "<model name='m'><static>1</static>{}</model>"),
    (JOINED.format("{0}", ""), IN_ONE), (JOINED.format("{0}", APART), IN_ONE),
    ("<visual name='v{0}'><geometry><sphere/></geometry></visual>",
     "<model name='m'><link name='l'>{}</link></model>"),
    ("<collision name='v{0}'><geometry><sphere/></geometry></collision>",
     "<model name='m'><link name='l'>{}</link></model>")])
def test_the_processor_time_for_a_world_is_linear(tmp_path, part, around):
    texts = TextChecker(documented(), open_resources(os.environ))
    file = tmp_path / "w.world"

    def seconds(count: int) -> float:
        parts = "".join(part.format(number) for number in range(count))
        file.write_text(f"<sdf version='1.6'><world name='w'>{around.format(parts)}</world></sdf>")
        began = time.process_time()
        assert texts.world_file(file)[0].status == WORKS
        return time.process_time() - began

    def is_linear() -> int:
        seconds(10)  # what is read only once
        # 4 times in proportion, 16 by the square. Once more where another process was in the way.
        return 0 if any(seconds(300) < 8 * max(seconds(75), 0.01) for _ in range(3)) else 1

    # In a process of its own, as check does it: who has drawn and then forks has a broken driver.
    assert run_bounded(is_linear, "w.world", seconds=250.0, most_bytes=2**33) == 0


@pytest.mark.parametrize("count, poses, said", [
    (60, "<pose>0.1 0 0.5 0 0 0</pose>", "PROBLEM       it says: world w, model 'b50': too many "
     "shapes lie in one another at 0.1 0 0.5, so that a step would take minutes; give each a "
     "<pose> of its own; it and 9 models after it are left out"),
    (60, APART, "works         world w (60 models)"),
    (60, "<static>1</static>", "works         world w (60 models)")])
def test_a_crowd_of_movable_models_is_told_in_one_line(check, count, poses, said):
    boxes = "".join(BOX.format(number, poses.format(number)) for number in range(count))
    code, table = check("w.world", f"<sdf version='1.6'><world name='w'>{boxes}</world></sdf>")
    assert code == ("PROBLEM" in said) and said in table
