"""The command line of spawn_model, and the XML it takes from files, parameters and text."""

import io
import math
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
import rospy
from gazebo_ros import model_source, spawning

NEEDED = ["-urdf", "-param", "robot_description", "-model", "car"]


def parse(*words):
    return spawning.parser().parse_args(words)


def test_defaults(monkeypatch):
    # conforms: spawn_model, spawn_model/-robot_namespace
    monkeypatch.setattr(rospy, "get_namespace", lambda: "/tb3_0/")
    options = parse(*NEEDED)
    assert (options.urdf, options.sdf, options.param, options.model) \
        == (True, False, "robot_description", "car")
    assert (options.gazebo_namespace, options.robot_namespace, options.reference_frame) \
        == ("/gazebo", "/tb3_0/", "")
    assert (options.wait, options.unpause, options.b, options.package_to_model, options.joints) \
        == (None, False, False, False, [])
    assert spawning.pose_from(options).orientation.w == 1.0


def test_pose_and_negative_numbers():
    # conforms: spawn_model/-x, spawn_model/-y, spawn_model/-z, spawn_model/-R, spawn_model/-P
    # conforms: spawn_model/-Y
    pose = spawning.pose_from(parse(*NEEDED, "-x", "-1.5", "-y", "2", "-Y", str(math.pi / 2)))
    assert (pose.position.x, pose.position.y, pose.position.z) == (-1.5, 2.0, 0.0)
    assert math.isclose(pose.orientation.z, math.sqrt(0.5))
    pose = spawning.pose_from(parse(*NEEDED, "-R", "0.1", "-P", "0.2", "-Y", "0.3"))
    # tf.transformations.quaternion_from_euler(0.1, 0.2, 0.3)
    expected = (0.0342708, 0.1060205, 0.1435722, 0.9833474)
    turn = pose.orientation
    assert (turn.x, turn.y, turn.z, turn.w) == pytest.approx(expected, abs=1e-6)


def test_prefixes_of_flags_are_enough():
    # conforms: spawn_model/prefixes of flags
    options = parse(*NEEDED, "-gazebo", "/sim", "-ref", "map", "-robot", "r1")
    assert (options.gazebo_namespace, options.reference_frame, options.robot_namespace) \
        == ("/sim", "map", "r1")


@pytest.mark.parametrize("words", [
    [], NEEDED[1:], NEEDED[:-2], ["-urdf", "-model", "car"], [*NEEDED, "-sdf"],
    [*NEEDED, "-file", "x"], [*NEEDED, "-trimesh"], [*NEEDED, "-x", "far"],
    [*NEEDED, "-x", "-1e-3"], [*NEEDED, "-J", "wheel"],
])
def test_a_wrong_command_line_is_exit_code_2(words, capsys):
    # conforms: spawn_model/exit codes
    with pytest.raises(SystemExit) as caught:
        parse(*words)
    assert caught.value.code == 2 and "usage: spawn_model" in capsys.readouterr().err


def test_joint_positions():
    # conforms: spawn_model/-J
    options = parse(*NEEDED, "-J", "a", "1.5", "-J", "b", "-0.5")
    assert spawning.joint_positions(options.joints) == [1.5, -0.5]
    options = parse(*NEEDED, "-J", "a", "1", "-J", "b", "up")
    with pytest.raises(ValueError, match="Error: -J b up: up is not a number"):
        spawning.joint_positions(options.joints)


def load(*source):
    return model_source.load(parse("-urdf", "-model", "car", *source))


def test_a_file_keeps_its_meaning(tmp_path):
    # conforms: spawn_model/-file
    path = tmp_path / "car.urdf"
    path.write_bytes('<?xml version="1.0" encoding="utf-8"?><!-- 注 --><robot name="车"/>'.encode())
    text = load("-file", str(path))
    assert text.isascii() and ElementTree.fromstring(text).get("name") == "车"


@pytest.mark.parametrize(("content", "said"), [
    (None, "Error: specified file {} does not exist"), ("folder", "Error: specified file {} is not"
     " a file"), (b"", "Error: file {} is empty"), (b"<robot>", "Invalid XML: no element found"),
])
def test_files_that_cannot_be_used(tmp_path, content, said):
    # conforms: spawn_model/-file, spawn_model/log lines
    path = tmp_path / "car.urdf"
    if content == "folder":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(model_source.SourceError) as caught:
        load("-file", str(path))
    assert str(caught.value).startswith(said.format(path))
    assert isinstance(caught.value, model_source.NoSuchFileError) == ("specified" in said)


@pytest.mark.parametrize("typed", ["~/car.urdf", "$HOME/car.urdf"])
def test_a_name_that_no_shell_has_expanded(monkeypatch, typed):
    monkeypatch.setenv("HOME", "/people/ann")
    with pytest.raises(model_source.NoSuchFileError) as caught:
        load("-file", typed)
    assert str(caught.value) == (f"Error: specified file {typed} does not exist; ~ and $ are not "
                                 "expanded here: write /people/ann/car.urdf")


@pytest.mark.parametrize("declaration", ["", '<?xml version="1.0" encoding="gb2312"?>\n',
                                         '<?xml version="1.0" encoding="utf-8"?>\n'])
def test_a_file_in_a_chinese_encoding(tmp_path, declaration):
    path = tmp_path / "car.urdf"
    path.write_bytes(f'{declaration}<robot name="car">\n<!-- 小车 -->\n</robot>'.encode("gb2312"))
    with pytest.raises(model_source.SourceError) as caught:
        load("-file", str(path))
    line = 3 if declaration else 2
    assert str(caught.value) == (f"Invalid XML: file {path}, line {line}: not UTF-8; save it as "
                                 "UTF-8")


def test_text_in_a_chinese_encoding(monkeypatch):
    raw = io.BytesIO("<robot><!-- 小车 --></robot>".encode("gb2312"))
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(raw, encoding="utf-8"))
    with pytest.raises(model_source.SourceError, match="stdin: not UTF-8; save the file as UTF-8"):
        load("-stdin")


XACRO = ('<robot name="car"{}><xacro:property name="w" value="0.1"/>'
         '<link name="base"><box size="${{w}} 1 1"/></link></robot>')
DECLARED = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'


@pytest.mark.parametrize("declared", [DECLARED, ""])
def test_a_xacro_file_that_is_not_processed(tmp_path, monkeypatch, declared):
    path = tmp_path / "car.urdf.xacro"
    path.write_text(XACRO.format(declared))
    with pytest.raises(model_source.SourceError) as caught:
        load("-file", str(path))
    assert str(path) in str(caught.value)
    assert str(caught.value).endswith(
        f"; run xacro first: rosrun xacro xacro {path} > {tmp_path}/car.urdf")
    monkeypatch.setattr(rospy, "get_param", lambda name: XACRO.format(declared))
    with pytest.raises(model_source.SourceError) as caught:
        load("-param", "robot_description")
    assert "parameter /robot_description" in str(caught.value)
    assert str(caught.value).endswith('; run xacro first: <param name="robot_description" '
                                      'command="$(find xacro)/xacro FILE"/>')


def test_the_command_that_runs_xacro_does_not_write_over_its_file(tmp_path):
    path = tmp_path / "car.urdf"
    path.write_text(XACRO.format(DECLARED))
    with pytest.raises(model_source.SourceError) as caught:
        load("-file", str(path))
    assert str(caught.value).endswith(f"xacro {path} > {tmp_path}/car_processed.urdf")


def test_what_xacro_has_written_may_still_name_it(monkeypatch):
    monkeypatch.setattr(rospy, "get_param", lambda name: f'<robot name="car"{DECLARED}/>')
    assert load("-param", "robot_description").startswith("<robot")


def test_standard_input(monkeypatch):
    # conforms: spawn_model/-stdin
    monkeypatch.setattr("sys.stdin", io.StringIO('<robot name="r"/>'))
    assert load("-stdin") == '<robot name="r" />'
    with pytest.raises(model_source.SourceError, match="Error: stdin buffer was empty"):
        load("-stdin")


def test_the_model_database_is_an_include():
    # conforms: spawn_model/-database
    root = ElementTree.fromstring(load("-database", "coke_can"))
    assert root.find("world[@name='default']/include/uri").text == "model://coke_can"


def test_package_to_model(monkeypatch):
    # conforms: spawn_model/-package_to_model
    text = '<robot><mesh filename="package://p/a.dae"/><mesh filename="file:///package://"/></robot>'
    monkeypatch.setattr(rospy, "get_param", lambda name: text)
    meshes = ElementTree.fromstring(load("-param", "d", "-package_to_model")).findall("mesh")
    assert [m.get("filename") for m in meshes] == ["model://p/a.dae", "file:///package://"]
    assert "package://p/a.dae" in load("-param", "d")


def test_a_missing_parameter_names_those_there_are(monkeypatch):
    # conforms: spawn_model/-param
    def missing(name):
        raise KeyError(name)

    monkeypatch.setattr(rospy, "get_param", missing)
    monkeypatch.setattr(rospy, "get_param_names", lambda: ["/b/robot_description", "/rate"])
    with pytest.raises(model_source.SourceError) as caught:
        load("-param", "robot_description")
    assert str(caught.value) == ("Error: parameter /robot_description is not set; "
                                 "there are: /b/robot_description")


def test_an_empty_parameter(monkeypatch):
    # conforms: spawn_model/-param
    monkeypatch.setattr(rospy, "get_param", lambda name: "")
    with pytest.raises(model_source.SourceError, match="param does not exist or is empty"):
        load("-param", "robot_description")


def test_a_file_that_cannot_be_read(tmp_path, monkeypatch):
    # conforms: spawn_model/-file, spawn_model/log lines
    path = tmp_path / "car.urdf"
    path.write_text("<robot/>")

    def fails(_path):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", fails)
    with pytest.raises(model_source.SourceError, match=f"Error reading file {path}: .*Permission"):
        load("-file", str(path))


def test_it_starts_without_numpy():
    """Which would be half of its start."""
    code = "import sys, gazebo_ros.spawning; print('numpy' in sys.modules)"
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "False\n"
