"""Robots and models with one wrong value are spawned without it, as by Gazebo; others are not."""

import logging

import pytest

INERTIAL = """<inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"""
ROBOT = f"""<robot name="r"><link name="a">{INERTIAL}</link><link name="b">{INERTIAL}</link>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="%s"/></joint>
    <gazebo reference="a"><mu1>%s</mu1></gazebo></robot>"""


@pytest.mark.parametrize("service, text, said", [
    ("urdf", ROBOT % ("0 0 0", 1), "the axis 0 0 0 has no direction; 1 0 0 is used instead"),
    ("urdf", (ROBOT % ("0 0 1", "high")).replace("</link><link", "<collision><geometry><sphere "
     'radius="1"/></geometry></collision></link><link', 1), "<mu1>: 'high' is not a number"),
    ("sdf", "<sdf version='1.6'><model><pose>1 2 3</pose><link name='l'/></model></sdf>",
     "model 'bot' <pose>: '1 2 3' is not 6 numbers; 0 0 0 0 0 0 is used instead"),
])
def test_one_wrong_value_is_an_error_line_and_a_success(bench, caplog, service, text, said):
    # conforms: SDF 1.2 to 1.7/values that cannot be read
    response = bench.call(f"/gazebo/spawn_{service}_model", model_name="bot", model_xml=text)
    assert response.success, response.status_message
    assert "bot" in bench.world.models
    (line,) = [r.getMessage() for r in caplog.records if r.levelno == logging.ERROR]
    assert said in line


@pytest.mark.parametrize("axis", ["0 0", "x 0 0"])
def test_what_urdfdom_refuses_stays_refused(bench, axis):
    response = bench.call("/gazebo/spawn_urdf_model", model_name="bot", model_xml=ROBOT % (axis, 1))
    assert not response.success
    assert "is not 3 numbers" in response.status_message
    assert "bot" not in bench.world.models
