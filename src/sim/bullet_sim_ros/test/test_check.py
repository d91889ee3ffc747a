"""rosrun bullet_sim_ros check: what it finds, how it says so, and its exit code."""

from pathlib import Path

import pytest

from bullet_sim_ros.check.command import main

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
     "what it moves or tells is missing"),
    ('<gazebo reference="base"><sensor name="s" type="ray"><plugin name="p" '
     'filename="libmy_own.so"/></sensor></gazebo>', "its topics will be missing"),
])
def test_an_unknown_plugin_is_named_with_what_is_lost(check, where, matters):
    code, said = check("robot.urdf", ROBOT.format(where))
    assert code == 1
    assert f"NOT THERE     plugin p (libmy_own.so): not known here: {matters}" in said


def test_a_known_plugin_works_and_a_tag_it_has_not_is_ignored(check):
    plugin = """<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so">
      <bodyName>base</bodyName><topicName>t</topicName><typo>1</typo></plugin></gazebo>"""
    code, said = check("robot.urdf", ROBOT.format(plugin), "--all")
    assert code == 0
    assert "works         plugin p (libgazebo_ros_p3d.so)" in said
    assert "ignored       plugin p (libgazebo_ros_p3d.so) <typo>" in said


def test_a_missing_mesh_and_broken_xml_are_problems(check):
    robot = ROBOT.format("").replace('<box size="1 1 1"/>',
                                     '<mesh filename="package://bullet_sim_ros/no.stl"/>')
    code, said = check("robot.urdf", robot)
    assert code == 1 and "PROBLEM" in said and "no.stl" in said
    code, said = check("robot.urdf", ROBOT.format("")[:-9])
    assert code == 1 and "PROBLEM       robot:" in said


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
    code, said = check("a.launch", LAUNCH.format("robot_descr", "gazebo_ros", "no_such"))
    assert code == 1
    assert "node gazebo_ros/no_such: package gazebo_ros has no executable no_such" in said
    assert "PROBLEM       spawn_model -param robot_descr: no parameter /robot_descr" in said
    assert "PROBLEM       launch file:" in check("a.launch", "<launch>")[1]


def test_a_package_is_looked_through(capsys):
    assert main(["learning_topic"]) == 0
    said = capsys.readouterr().out
    assert "course.world" in said and "0course.launch, parameter /robot_description" in said


def test_nothing_to_check_and_a_wrong_launch_file(capsys):
    assert main(["no_such_package"]) == 2
    assert "check: no_such_package: no such file or package" in capsys.readouterr().err
    assert main(["learning_topic", "0curse.launch"]) == 1
    assert "not there; there are: 0course.launch" in capsys.readouterr().out
    assert not Path("no_such_package").exists()
