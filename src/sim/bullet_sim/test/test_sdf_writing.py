"""A robot written as SDF is, read again, the same robot."""

import re
from dataclasses import replace

import pytest

from bullet_sim.description import LinkDescription, ModelDescription, Polyline, Visual
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.sdf.writing import sdf_text

INERTIAL = """<inertial><origin xyz="0.1 0 0"/><mass value="2"/>
<inertia ixx="1" iyy="1.5" izz="2" ixy="0" ixz="0.1" iyz="0"/></inertial>"""
ROBOT = f"""<robot name="cart">
<link name="body">{INERTIAL}<visual><geometry><mesh filename="MESH" scale="1 2 3"/></geometry>
</visual><collision><geometry><box size="1 2 3"/></geometry></collision></link>
<link name="wheel">{INERTIAL}<collision><origin rpy="1 0 0"/><geometry><cylinder radius="0.2"
length="0.1"/></geometry></collision></link>
<link name="arm">{INERTIAL}<visual><geometry><sphere radius="0.3"/></geometry></visual></link>
<joint name="axle" type="continuous"><parent link="body"/><child link="wheel"/>
<origin xyz="0 0.5 0" rpy="0.3 0 0"/><axis xyz="0 0 1"/><dynamics damping="0.2"/></joint>
<joint name="lift" type="prismatic"><parent link="body"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1" effort="5" velocity="2"/></joint>
<gazebo reference="wheel"><mu1>0.5</mu1><mu2>0.4</mu2><kp>1e6</kp></gazebo>
<gazebo reference="body"><sensor name="eye" type="camera"><update_rate>5</update_rate>
<plugin name="p" filename="libgazebo_ros_camera.so"/></sensor></gazebo>
<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so"><leftJoint>axle</leftJoint>
</plugin></gazebo></robot>"""


def parts(model):
    """What the two have to agree in; elements of plugins and sensors are compared by name."""
    links = [replace(link, sensors=tuple(s.name for s in link.sensors), visuals=tuple(
        (visual.name, visual.geometry, visual.pose) for visual in link.visuals))
        for link in model.links]
    return links, [replace(joint, type="") for joint in model.joints], [
        (plugin.filename, plugin.element.findtext("leftJoint")) for plugin in model.plugins]


def rounded(values):
    """As text, to a millionth, and without a minus before zero."""
    return re.sub(r"-?\d+\.?\d*(e[-+]\d+)?",
                  lambda number: f"{round(float(number[0]), 6) + 0.0:g}", str(values))


def test_a_robot_written_and_read_again_is_the_same(tmp_path):
    mesh = tmp_path / "a.stl"
    mesh.touch()
    robot = load_model(ROBOT.replace("MESH", f"file://{mesh}"), Resources())
    again = load_model(sdf_text(robot), Resources())
    assert rounded(parts(again)) == rounded(parts(robot))
    assert [joint.type for joint in again.joints] == ["revolute", "prismatic"]


def test_a_shape_that_urdf_cannot_have_is_named():
    model = ModelDescription(name="m", links=(LinkDescription(
        name="l", visuals=(Visual("v", Polyline(())),)),))
    with pytest.raises(FormatError, match="<polyline> cannot be written"):
        sdf_text(model)
