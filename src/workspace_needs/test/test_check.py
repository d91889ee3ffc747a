"""rosrun bullet_sim_ros check: what it finds, how it says so, and its exit code."""

import mmap
import os
import re
import threading
import time
from pathlib import Path

import pytest
import rospkg
import rospy
from workspace_needs.check import contents, launch_files, workspaces
from workspace_needs.check.command import main
from workspace_needs.check.findings import PROBLEM, Finding, table

# A file is checked in a fork of this process, which must not hold engines or OpenGL of other tests.
pytestmark = pytest.mark.processes

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><box size="1 1 1"/></geometry></visual></link>{}</robot>"""
WORLD = """<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri></include>
  {}</world></sdf>"""
LAUNCH = """<launch><arg name="who" default="r"/>
  <param name="robot_description" textfile="$(dirname)/robot.urdf"/>
  <node name="s" pkg="gazebo_ros" type="spawn_model" args="-urdf -param {} -model $(arg who)"/>
  <node name="n" pkg="{}" type="{}"/></launch>"""


@pytest.fixture
def check(tmp_path, capsys):
    """Checks a text under a file name: exit code and what was printed."""
    def run(name: str, text: str, *arguments: str) -> tuple[int, str]:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        code = main([str(path), *arguments])
        return code, capsys.readouterr().out
    return run


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


JOINTED = ROBOT.format("""<link name="wheel"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j" type="continuous"><parent link="base"/><child link="wheel"/></joint>{}""")
DRIVE = """<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">
  <{tag}>j</{tag}><rightJoint>j</rightJoint><odometryTopic>odom</odometryTopic></plugin></gazebo>"""
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


def test_a_launch_file_with_its_robot_and_its_nodes(check, tmp_path):
    (tmp_path / "robot.urdf").write_text(ROBOT.format(""))
    code, said = check("a.launch", LAUNCH.format("robot_description", "gazebo_ros", "spawn_model"))
    assert code == 0, said
    assert "parameter /robot_description\n  works         model r" in said
    code, said = check("a.launch", LAUNCH.format("robot_description", "no_such_pkg", "x"))
    assert code == 1 and "NOT THERE     node no_such_pkg/x: package no_such_pkg is not here" in said
    code, said = check("a.launch", LAUNCH.format("robot_description", "slam_karto", "x"))
    assert code == 1 and "package slam_karto is not here: not in Debian; gmapping makes" in said
    code, said = check("a.launch", LAUNCH.format("robot_descr", "gazebo_ros", "no_such"))
    assert code == 1
    assert "node gazebo_ros/no_such: package gazebo_ros has no executable no_such" in said
    assert "PROBLEM       spawn_model -param robot_descr: no parameter /robot_descr" in said
    assert "PROBLEM       launch file:" in check("a.launch", "<launch>")[1]


@pytest.mark.parametrize(("package", "name", "near"), [
    ("gazebo_ros", "spawn_modle", "spawn_model"),
    ("learning_topic", "06folower_pid.py", "06follower_pid.py"), ("learning_topic", "zzz", "")])
def test_a_mistyped_node_is_answered_with_the_nearest(check, tmp_path, package, name, near):
    (tmp_path / "robot.urdf").write_text(ROBOT.format(""))
    said = check("a.launch", LAUNCH.format("robot_description", package, name))[1]
    assert f"did you mean {near}?" in said if near else "did you mean" not in said


def test_a_package_is_looked_through(capsys):
    assert main(["learning_topic"]) == 0
    said = capsys.readouterr().out
    assert "course.world" in said and "0course.launch, parameter /robot_description" in said


def test_nothing_to_check_and_a_wrong_launch_file(capsys):
    assert main(["no_such_package"]) == 2
    assert "check: no_such_package: no such file or package" in capsys.readouterr().err
    assert main(["learning_topic", "0curse.launch"]) == 1
    assert ("not there (did you mean 0course.launch?); there are: 0course.launch"
            in capsys.readouterr().out)
    assert main(["learning_topik"]) == 2
    assert "package (did you mean learning_topic?); try" in capsys.readouterr().err
    assert not Path("no_such_package").exists()


def test_controllers_of_a_launch_file(check, tmp_path):
    (tmp_path / "robot.urdf").write_text(ROBOT.format(""))
    (tmp_path / "c.yaml").write_text("""
state: {type: joint_state_controller/JointStateController}
arm: {type: my_things/Controller}
other: {type: their_things/Planner}
wheel: {type: velocity_controllers/JointVelocityControler, joint: j}""")
    code, said = check("a.launch", """<launch><rosparam file="$(dirname)/c.yaml" ns="r"/>
      <node name="s" pkg="controller_manager" type="spawner" ns="r" args="state arm"/></launch>""")
    assert code == 1
    assert "works         controller /r/state (joint_state_controller/JointStateController" in said
    assert ("NOT THERE     controller /r/wheel (velocity_controllers/JointVelocityControler): "
            "there is no such type of controller here (did you mean velocity_controllers/JointVeloc"
            "ityController?)") in said
    assert "NOT THERE     controller /r/arm (my_things/Controller)" in said
    assert "their_things" not in said


@pytest.fixture
def package(tmp_path):
    """A package with files of these names and texts; its folder."""
    def make(**texts: str) -> str:
        (tmp_path / "package.xml").write_text("<package><name>p</name></package>")
        for name, text in texts.items():
            (tmp_path / name.replace("__", ".")).write_text(text)
        return str(tmp_path)
    return make


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


def test_launch_files_that_need_arguments(package, capsys):
    folder = package(part__launch="""<launch><arg name="model"/><arg name="x" default="0"/>
      <arg name="world"/></launch>""")
    assert main([folder]) == 0
    said = capsys.readouterr().out
    assert "not checked   launch file: it needs model:=… world:=…; rosrun bullet_sim_ros" in said
    assert said.endswith("all that was checked will work\n")
    assert main([f"{folder}/part.launch", "world:=w"]) == 1
    assert "PROBLEM       launch file: it needs model:=…; " in capsys.readouterr().out
    assert main([f"{folder}/part.launch", "world:=w", "model:=m"]) == 0


def test_an_argument_without_a_name_is_roslaunchs_to_complain_of(check):
    code, said = check("a.launch", "<launch><arg/></launch>")
    assert code == 1 and "PROBLEM       launch file: Invalid <arg> tag: 'name'" in said


@pytest.mark.parametrize("name", ["/b.launch", "sub/a.launch", "*.launch"])
def test_a_launch_file_that_a_package_does_not_have(package, capsys, name):
    assert main([package(a__launch="<launch/>"), name]) == 1
    assert "there are: a.launch" in capsys.readouterr().out


def test_arguments_in_quotation_marks(check, tmp_path):
    (tmp_path / "my robot.urdf").write_text(ROBOT)
    node = ('<launch><node pkg="gazebo_ros" type="spawn_model" name="s" '
            'args="-urdf -file \'{}/my robot.urdf\' -model r{}"/></launch>')
    code, said = check("a.launch", node.format(tmp_path, ""))
    assert code == 0 and "my robot.urdf\n  works         model" in said
    assert "works         node gazebo_ros/spawn_model" in check("a.launch", node.format("", "'"))[1]


def test_commands_run_once_and_files_are_read_once(check, tmp_path):
    runs = tmp_path / "runs"
    again = f'<param name="{{}}" command="bash -c \'echo x >> {runs}; echo made\'"/>'
    text = f"<launch>{again.format('a')}{again.format('b')}</launch>"
    code, said = check("a.launch", text, "--run-commands")
    assert code == 0, said
    assert runs.read_text() == "x\n"


@pytest.mark.parametrize("command", [
    "touch {}", "bash -c 'touch {}'", "cat {} --help", "xacro -o {} {}", "rosrun xacro other {}",
    "python3 -c 'open(&quot;{}&quot;, &quot;w&quot;)'",
])
def test_what_is_looked_at_is_not_run(check, tmp_path, command):
    made = tmp_path / "made"
    command = command.replace("{}", str(made))
    node = '<node pkg="gazebo_ros" type="spawn_model" name="s" args="-urdf -param r -model m"/>'
    code, said = check("a.launch", f'<launch><param name="r" command="{command}"/>{node}</launch>')
    assert not made.exists()
    assert code == 0 and "not checked   parameter /r: its command is not run: " in said
    assert "--run-commands runs it" in said


def test_eval_writes_no_file(check, tmp_path):
    made = tmp_path / "made"
    code, said = check("a.launch",
                       f"<launch><arg name='a' default=\"$(eval open('{made}', 'w'))\"/></launch>")
    assert code == 1 and "'open' is not defined" in said
    assert not made.exists()


@pytest.mark.parametrize("command, works", [
    ("xacro {} name:=car", True), ("$(find xacro)/xacro --inorder {}", True),
    ("rosrun xacro xacro.py {}", True), ("cat {}", True), ("xacro {}.not_there", False),
])
def test_xacro_and_cat_are_done_without_running_them(check, tmp_path, command, works):
    (tmp_path / "car.urdf").write_text(ROBOT)
    node = '<node pkg="gazebo_ros" type="spawn_model" name="s" args="-urdf -param r -model m"/>'
    command = command.replace("{}", str(tmp_path / "car.urdf"))
    code, said = check("a.launch", f'<launch><param name="r" command="{command}"/>{node}</launch>')
    assert ("parameter /r\n  works         model" in said) is works, said
    assert (code == 0) is works


@pytest.mark.parametrize("inside, words", [
    ('<param name="a" textfile="{}/pipe"/>', "/pipe cannot be read: it is a pipe or device"),
    ('<param name="a" textfile="/dev/zero"/>', "/dev/zero cannot be read: it is a pipe or device"),
    ('<param name="a" value="$(eval 2**2**40)"/>', "takes more than 3 s or 1 GiB; look at its $("),
    ('<arg name="a" default="$(eval list(range(10**9)))"/>',
     "Invalid <arg> tag: to read it takes more than 3 s or 1 GiB; look at its $("),
    ('<include file="{}/a.launch"/>', "a.launch includes itself without end; remove the <include>"),
    ('<include file="{}/b.launch"/>', "a.launch includes itself by way of "),
    ("<group>" * 1500 + "</group>" * 1500, "elements are nested too deep"),
])
def test_launch_files_that_do_not_end(check, tmp_path, inside, words):
    if "pipe" in inside:
        os.mkfifo(tmp_path / "pipe")
    (tmp_path / "b.launch").write_text(f'<launch><include file="{tmp_path}/a.launch"/></launch>')
    code, said = check("a.launch", f"<launch>{inside.replace('{}', str(tmp_path))}</launch>")
    (line,) = [line for line in said.splitlines() if "PROBLEM" in line]
    assert code == 1 and words in line, said


def test_packages_that_are_not_there_are_looked_for_once(check, monkeypatch):
    crawled, crawl = [], rospkg.rospack.list_by_path
    monkeypatch.setattr(rospkg.rospack, "list_by_path",
                        lambda *what: crawled.append(what) or crawl(*what))

    def folders_crawled(count):
        crawled.clear()
        nodes = "".join(f'<node pkg="no_such_{i}" type="t" name="n{i}"/>' for i in range(count))
        assert check("a.launch", f"<launch>{nodes}</launch>")[1].count("clone it") == count
        return len(crawled)

    assert folders_crawled(5) == folders_crawled(1) > 0


def test_the_memory_of_whoever_asks_does_not_count(check):
    large = mmap.mmap(-1, 3 << 29, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    text = f'<param name="a" value="{"x" * 1000}"/>' * 2000
    try:
        code, said = check("a.launch", f"<launch>{text}</launch>")
        assert code == 0, said
    finally:
        large.close()


def test_a_part_that_many_robots_include_is_no_circle(check, tmp_path):
    (tmp_path / "one.launch").write_text("<launch/>")
    inside = f'<include file="{tmp_path}/one.launch"/>' * 30
    assert check("a.launch", f"<launch>{inside}</launch>")[0] == 0


def test_a_command_that_waits_is_ended(check, tmp_path, monkeypatch):
    monkeypatch.setattr(launch_files, "LONGEST_WAIT", 15)  # roslaunch runs one of its own first
    pid = tmp_path / "pid"
    code, said = check("a.launch", '<launch><param name="a" command="bash -c \'echo $$ > '
                       f'{pid}; exec sleep 100\'"/></launch>', "--run-commands")
    assert code == 1 and "its command has not ended after 15 s: bash -c 'echo $$" in said
    stat = Path(f"/proc/{int(pid.read_text())}/stat")
    for _ in range(600):
        try:
            if ") Z " in stat.read_text():  # dead; nobody may be there to collect it
                return
        except OSError:
            return
        time.sleep(0.1)
    pytest.fail("its command still runs")


def test_memory_that_runs_out_is_said_as_such():
    assert "1 GiB; look at its $(eval" in launch_files._error_line(MemoryError())


def test_files_that_are_not_utf8(check, tmp_path):
    (tmp_path / "a.urdf").write_bytes(b"<robot name='r'>\n<!-- \xd6\xd0 --></robot>")
    assert main([str(tmp_path / "a.urdf")]) == 1
    model = "<sdf version='1.6'><model name='m'><link name='l'/></model></sdf>"
    (tmp_path / "a.sdf").write_bytes(model.encode("utf-16"))
    launch = ('<launch><node name="s" pkg="gazebo_ros" type="spawn_model" '
              f'args="-sdf -file {tmp_path}/a.sdf -model m"/></launch>')
    code, said = check("a.launch", launch)
    assert "a.urdf, line 2: this is not UTF-8, which roslaunch needs; save the file" in said
    assert code == 0 and "works         model m" in said


@pytest.mark.parametrize("name, content", [
    ("a", b"a: \xe9"), ("b", b"a: \xe9 b"), ("c", "a: 1".encode("utf-16"))])
def test_a_parameter_file_that_is_not_utf8(check, tmp_path, name, content):
    (tmp_path / f"{name}.yaml").write_bytes(content)
    inside = f'<rosparam file="{tmp_path}/{name}.yaml"/>'
    code, said = check("a.launch", f"<launch>{inside}</launch>")
    assert code == 1 and "tag: it is not UTF-8; save it as UTF-8 XML is <rosparam file=" in said


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


def test_a_workspace_before_it_is_built(tmp_path, capsys):
    for name, component in (("arm", "moveit_core"), ("wheel", "roscpp")):
        folder = tmp_path / "src" / name
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(
            f"<package format='2'><name>{name}</name><version>1.0.0</version><license>BSD</license>"
            "<description>d</description><maintainer email='a@example.com'>a</maintainer>"
            "</package>")
        (folder / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.0.2)\nproject({name})\n"
            f"find_package(catkin REQUIRED COMPONENTS {component})")
    code = main([str(tmp_path)])
    said = capsys.readouterr().out
    assert code == 1
    assert "PROBLEM       build: it is left out: moveit_core: MoveIt is not in Debian" in said
    wheel = said[said.index("package wheel"):]
    assert "works         build" in wheel or "roscpp needs it: make deps WS=" in wheel


@pytest.fixture
def workspace(tmp_path, capsys):
    """Checks a workspace that is not built, of one package `arm`: exit code and what is printed."""
    folder = tmp_path / "src/arm"
    (folder / "scripts").mkdir(parents=True)
    (folder / "package.xml").write_text(
        "<package format='2'><name>arm</name><version>1.0.0</version><license>BSD</license>"
        "<description>d</description><maintainer email='a@example.com'>a</maintainer>"
        "<buildtool_depend>catkin</buildtool_depend></package>")
    (folder / "main.cpp").write_text("int main() {}\n")
    (folder / "scripts/talk.py").write_text("#!/usr/bin/env python3\n")
    (folder / "scripts/talk.py").chmod(0o755)

    def run(cmake: str = "", **files: str) -> tuple[int, str]:
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.0)\nproject(arm)\nfind_package(catkin REQUIRED)\n"
            f"catkin_package()\n{cmake}")
        for name, text in files.items():
            (folder / name.replace("__", ".")).write_text(text)
        code = main([str(tmp_path)])
        return code, capsys.readouterr().out
    return run


def test_what_is_in_a_workspace_is_looked_at_before_it_is_built(workspace):
    launch = LAUNCH.replace("$(dirname)", "$(find arm)").format("robot_description", "arm", "n")
    cmake = ("add_executable(n main.cpp)\ncatkin_install_python(PROGRAMS scripts/talk.py\n"
             "  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})\n")
    code, said = workspace(cmake, robot__urdf=ROBOT.format(""), a__launch=launch, b__yaml="a: 1\n",
                           c__launch=launch.replace('type="n"', 'type="talk.py"'))
    assert code == 0 and said.endswith("all of it will work\n")
    assert "works         launch files, worlds, robots and YAML (4)" in said
    assert "a.launch" not in said
    code, said = workspace(cmake, a__launch=launch.replace('type="n"', 'type="nn"'))
    assert code == 1 and "node arm/nn: package arm has no executable nn here" in said
    assert "robots and YAML" not in said


@pytest.mark.parametrize("cmake, code, words", [
    ("", 0, "works         build"),
    ("add_executable(see EXCLUDE_FROM_ALL see.cpp)", 0, "works         build"),
    ("add_library(see STATIC EXCLUDE_FROM_ALL see.cpp)\nadd_executable(n main.cpp)\n"
     "target_link_libraries(n see)", 1, "PROBLEM       build: see.cpp will not compile"),
    ("add_executable(see see.cpp)", 1, "PROBLEM       build: see.cpp will not compile: the header "
                                       "<strange_msgs/Thing.h> is not here: neither")])
def test_a_header_that_nobody_has_matters_where_a_target_includes_it(workspace, cmake, code, words):
    got, said = workspace(cmake, see__cpp="#include <strange_msgs/Thing.h>\nint main() {}\n")
    assert got == code and words in said and "will be without" not in said
    assert ("works         build" in said) is (code == 0)


@pytest.mark.parametrize("name, text, why", [
    ("arm.urdf", "<robot", "PROBLEM       robot: "),
    ("arm.world", "<sdf", "PROBLEM       world: "),
    ("arm.yaml", "a:\n\tb: 1\n", "PROBLEM       YAML: "),
    ("arm.launch", "<launch><node/></launch>", "PROBLEM       launch file: "),
    ("arm.launch", "<launch><rosparam>\na: 1\nb: [1, 2\nc: 3\n</rosparam></launch>",
     "PROBLEM       launch file: YAML in <rosparam>: expected ',' or ']', but got ':'; line 4 of "
     "it: c: 3\n"),
])
def test_a_fault_in_a_workspaces_file_is_found(workspace, name, text, why):
    code, said = workspace(**{name.replace(".", "__"): text})
    assert code == 1 and f"/arm/{name}\n  {why}" in said
    assert "works         build" in said and said.endswith("something will be missing, see above\n")


def test_programs_of_a_package_that_does_not_configure_are_not_said_to_be_absent(workspace):
    launch = LAUNCH.format("robot_description", "arm", "n")
    code, said = workspace("message(FATAL_ERROR no)", robot__urdf=ROBOT.format(""),
                           a__launch=launch)
    assert code == 1 and "not checked   node arm/n: what the build makes of package arm" in said


def test_a_workspace_is_looked_at_for_a_bounded_time(workspace, monkeypatch):
    monkeypatch.setattr(workspaces, "LONGEST", -1.0)
    code, said = workspace(arm__urdf="<robot", b__yaml="a: 1\n")
    assert code == 0 and "not checked   2 of its 2 files: the -1 s for the workspace are" in said
    assert said.endswith("all that was checked will work\n")


def test_a_finding_is_translated_without_its_status(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    found = Finding("a", "build", PROBLEM, "it is left out: x: MoveIt is not in Debian")
    assert re.search(r"有问题 +build: 略去它：x：", table([found]))


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


def test_search_paths_that_a_launch_file_sets(package, tmp_path, capsys):
    (tmp_path / "crate").mkdir()
    (tmp_path / "crate/model.sdf").write_text(
        '<sdf version="1.6"><model name="crate"><static>1</static><link name="l"/></model></sdf>')
    world = WORLD.format("<include><uri>model://crate</uri></include>")
    launch = """<launch>{}<node pkg="gazebo_ros" type="gzserver" name="g" args="here.world"/>
      </launch>"""
    paths = "".join(f'<env name="GAZEBO_{kind}_PATH" value="{tmp_path}"/>'
                    for kind in ("RESOURCE", "MODEL"))
    folder = package(here__world=world)
    for env, code in (("", 1), (paths, 0)):
        package(a__launch=launch.format(env))
        assert main([f"{folder}/a.launch"]) == code, capsys.readouterr().out
    said = capsys.readouterr().out
    assert "here.world\n  works         world w (2 models)" in said


def test_xacro_that_a_package_runs_by_itself_is_said_to_be_unread(tmp_path, capsys, monkeypatch):
    folder = tmp_path / "own_spawner"
    (folder / "scripts").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>own_spawner</name></package>")
    script = folder / "scripts/spawn.sh"
    script.write_text("#!/bin/sh\nrosparam set robot_description \"$(xacro $1.xacro)\"\n")
    script.chmod(0o755)
    (folder / "a.launch").write_text(
        '<launch><node pkg="own_spawner" type="spawn.sh" name="s"/></launch>')
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{folder}:{os.environ['ROS_PACKAGE_PATH']}")
    assert main([f"{folder}/a.launch"]) == 0
    said = capsys.readouterr().out
    assert f"not checked   node own_spawner/spawn.sh: {script} runs xacro; the robot that" in said
    assert said.endswith("all that was checked will work\n")


def test_time_and_memory_of_a_file_are_bounded(check, monkeypatch):
    pile = "".join(f"<model name='m{n}'><link name='l'><collision name='c'><geometry><box/>"
                   "</geometry></collision></link></model>" for n in range(700))
    monkeypatch.setattr(contents, "LONGEST", 0.5)
    code, said = check("pile.world", WORLD.format(pile))
    assert code == 1
    assert "pile.world: checking it takes longer than 0.5 s of processor time; simplify" in said
    monkeypatch.setattr(contents, "LONGEST", 60.0)
    monkeypatch.setattr(contents, "MOST_BYTES", 2**23)
    code, said = check("pile.world", WORLD.format(pile))
    assert code == 1 and "pile.world: checking it needs more memory than there is" in said


def test_a_folder_that_is_no_workspace_and_one_that_is_named_by_its_src(tmp_path, capsys):
    assert main([str(tmp_path)]) == 2
    assert "this is not a workspace, it has no src/ with packages" in capsys.readouterr().err
    for place in ("a", "b"):
        (tmp_path / "src" / place).mkdir(parents=True)
        (tmp_path / "src" / place / "package.xml").write_text(
            "<package format='2'><name>arm</name><version>1.0.0</version><license>BSD</license>"
            "<description>d</description><maintainer email='a@example.com'>a</maintainer>"
            "</package>")
    assert main([str(tmp_path / "src")]) == 1
    assert "build: two packages are called arm: " in capsys.readouterr().out


def test_a_package_with_nothing_to_check_is_not_said_to_work(tmp_path, capsys):
    (tmp_path / "package.xml").write_text("<package/>")
    assert main([str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert said.out == "" and "there is nothing to check" in said.err


@pytest.mark.parametrize("text, code, words", [
    ("#!/usr/bin/env python3\ndef f(:\n", 1, "PROBLEM       line 2: Python 3 cannot read it: "),
    ("import nobodys\n", 1,
     "NOT THERE     line 1: module nobodys is not here: Debian has no python3-nobodys"),
    ("import numpy\nnumpy.float(1)\n", 0, "approximated  line 2: numpy.float is an old name: "),
    ("import rospy\n", 0, "works         first line, syntax and modules")])
def test_a_script_alone(check, text, code, words):
    got, said = check("talk.py", text)
    assert got == code and "talk.py\n  " + words in said
