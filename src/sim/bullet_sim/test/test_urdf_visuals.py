"""What a robot looks like to who draws it by its transforms."""

import logging

import pytest

from bullet_sim.description import Box, Cylinder, Sphere
from bullet_sim.errors import FormatError
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.urdf.link import read_robot_visuals

ROBOT = """<robot name="car">
  <material name="blue"><color rgba="0 0 1 0.5"/></material>
  <link name="footprint"/>
  <link name="base"><visual><origin xyz="0 0 1"/><geometry><box size="1 2 3"/></geometry>
    <material name="blue"/></visual></link>
  <link name="mast"><visual><geometry><capsule radius="0.1" length="1"/></geometry>
    <material name="own"><color rgba="1 0 0 1"/></material></visual>
    <visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <joint name="a" type="fixed"><parent link="footprint"/><child link="base"/>
    <origin xyz="0 0 0.5"/></joint>
  <joint name="b" type="fixed"><parent link="base"/><child link="mast"/>
    <origin xyz="1 0 0"/></joint>
</robot>"""


def read(text=ROBOT):
    return read_robot_visuals(text, Resources())


def test_every_link_stays_where_joints_at_zero_put_it():
    name, links = read()
    assert name == "car"
    places = {link: pose.position for link, (pose, _) in links.items()}
    assert places == {"footprint": (0, 0, 0), "base": (0, 0, 0.5), "mast": (1, 0, 0.5)}
    assert links["footprint"][1] == ()


def test_colours_are_the_visuals_own_or_the_robots_of_that_name():
    _, links = read()
    (box,) = links["base"][1]
    assert box.geometry == Box((1.0, 2.0, 3.0)) and box.pose.position == (0, 0, 1)
    assert box.material.diffuse == (0, 0, 1, 0.5)
    *capsule, ball = links["mast"][1]
    assert {type(part.geometry) for part in capsule} == {Cylinder, Sphere} and len(capsule) == 3
    assert all(part.material.diffuse == (1, 0, 0, 1) for part in capsule)
    assert ball.material is None


def test_a_texture_without_a_colour_is_seen_as_it_is(tmp_path):
    (tmp_path / "wood.png").write_bytes(b"")
    _, links = read(ROBOT.replace('<color rgba="0 0 1 0.5"/>',
                                  f'<texture filename="{tmp_path / "wood.png"}"/>'))
    (box,) = links["base"][1]
    assert box.material.diffuse == (1, 1, 1, 1)
    assert box.material.texture == str(tmp_path / "wood.png")


def test_what_cannot_be_read_is_left_out_with_a_warning(caplog):
    caplog.set_level(logging.WARNING)
    _, links = read(ROBOT.replace('size="1 2 3"', 'size="1 two 3"'))
    assert links["base"][1] == () and len(links["mast"][1]) == 4
    assert "link 'base': a visual is left out" in caplog.text and "two" in caplog.text


def test_other_texts_are_no_robot():
    with pytest.raises(FormatError, match="its root is <sdf>"):
        read("<sdf/>")
