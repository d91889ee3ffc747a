"""Transmissions and what controllers want to know of a URDF."""

import math
from xml.etree.ElementTree import fromstring

import pytest

from bullet_sim.description import JointLimits, SoftLimits
from bullet_sim.errors import FormatError, UnknownName
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.formats.urdf.transmission import Transmission, read_transmissions
from bullet_sim.formats.xml_values import parse_xml

EFFORT = "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>"
ACTUATOR = "<actuator name='m'/>"
TYPE = "<type>transmission_interface/SimpleTransmission</type>"


def read(body, name="name='t'"):
    return read_transmissions(
        parse_xml(f"<robot><transmission {name}>{body}</transmission></robot>", "a test"))


def test_what_is_usable():
    # conforms: urdf transmission/joint/hardwareInterface
    reduction = "<actuator name='m'><mechanicalReduction>50</mechanicalReduction></actuator>"
    for kind, interface in (("Effort", "effort"), ("Position", "position"),
                            ("Velocity", "velocity")):
        joint = f"<joint name='j'>{EFFORT.replace('Effort', kind)}</joint>"
        assert read(TYPE + joint + reduction) == [Transmission("t", "j", interface)]


def test_without_the_prefix_it_works_with_a_warning(caplog):
    plain = EFFORT.replace("hardware_interface/", "")
    assert read(f"{TYPE}<joint name='j'>{plain}</joint>{ACTUATOR}")[0].interface == "effort"
    assert "Deprecated syntax, please prepend 'hardware_interface/'" in caplog.text


@pytest.mark.parametrize(("body", "name", "why"), [
    (f"{TYPE}<joint name='j'>{EFFORT}</joint>{ACTUATOR}", "", "has no name"),
    (f"<joint name='j'>{EFFORT}</joint>{ACTUATOR}", "name='t'", "no <type>"),
    (f"{TYPE}{ACTUATOR}", "name='t'", "no <joint>"),
    (f"{TYPE}<joint name='j'>{EFFORT}</joint>", "name='t'", "no <actuator>"),
    (f"{TYPE}<joint>{EFFORT}</joint>{ACTUATOR}", "name='t'", "a <joint> of it has no name"),
    (f"{TYPE}<joint name='j'>{EFFORT}</joint><actuator/>", "name='t'", "a <actuator> of it"),
    (f"{TYPE}<joint name='j'/><actuator name='m'>{EFFORT}</actuator>", "name='t'",
     "No valid hardware interface element found in joint 'j'; its actuator has one, which belongs "
     "into the <joint>. Failed to load joints for transmission 't'."),
    (f"{TYPE}<joint name='j'>{EFFORT}</joint><joint name='k'>{EFFORT}</joint>{ACTUATOR}",
     "name='t'", "more than one joint"),
])
def test_what_is_left_out_and_why(caplog, body, name, why):
    assert read(body, name) == []
    assert why in caplog.text


def test_of_several_interfaces_the_first_counts(caplog):
    several = EFFORT.replace("Effort", "Velocity") + EFFORT
    assert read(f"{TYPE}<joint name='j'>{several}</joint>{ACTUATOR}")[0].interface == "velocity"
    assert "multiple hardware interfaces" in caplog.text


def test_of_two_transmissions_of_a_joint_the_first_counts(caplog):
    one = f"<transmission name='a'>{TYPE}<joint name='j'>{EFFORT}</joint>{ACTUATOR}</transmission>"
    two = one.replace("'a'", "'b'")
    assert [t.name for t in read_transmissions(fromstring(f"<robot>{one}{two}</robot>"))] == ["a"]
    assert "'b': joint 'j' already has transmission 'a'" in caplog.text


def test_an_unknown_interface_is_an_error():
    unknown = EFFORT.replace("Effort", "Torque")
    with pytest.raises(FormatError, match=r"No matching hardware interface found for .*Torque"):
        read(f"{TYPE}<joint name='j'>{unknown}</joint>{ACTUATOR}")


ROBOT = """
<robot name="r">
  <link name="base"/><link name="arm"/><link name="wheel">
    <collision><geometry><cylinder radius="0.3" length="0.1"/></geometry></collision></link>
  <link name="ball"><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>
    <limit lower="-1" upper="2" velocity="0" effort="0"/>
    <safety_controller soft_lower_limit="-0.5" soft_upper_limit="0.5" k_position="10"
                       k_velocity="3"/></joint>
  <joint name="axle" type="continuous"><parent link="arm"/><child link="wheel"/>
    <origin xyz="0.5 0 0"/></joint>
  <joint name="roll" type="continuous"><parent link="arm"/><child link="ball"/>
    <limit velocity="4" effort="5"/></joint>
</robot>"""


def test_facts_of_a_robot():
    facts = RobotFacts(fromstring(ROBOT))
    assert facts.limits("shoulder") == JointLimits(-1.0, 2.0, 0.0, effort=0.0,
                                                   soft=SoftLimits(-0.5, 0.5, 10.0, 3.0))
    assert facts.limits("axle") == JointLimits()
    assert facts.limits("roll") == JointLimits(velocity=4.0, effort=5.0)
    assert (facts.parent("axle"), facts.child("axle")) == ("arm", "wheel")
    assert facts.pose("axle").position == pytest.approx((1.0, 0.5, 0.0))
    assert facts.pose("axle").rpy()[2] == pytest.approx(math.pi / 2)
    assert (facts.wheel_radius("axle"), facts.wheel_radius("roll")) == (0.3, 0.2)


def test_errors_of_facts_say_what_there_is():
    facts = RobotFacts(fromstring(ROBOT))
    with pytest.raises(UnknownName, match=r"'axel'; there are: .*axle"):
        facts.limits("axel")
    with pytest.raises(FormatError, match="'shoulder' is not known: link 'arm' has no"):
        facts.wheel_radius("shoulder")
    broken = ROBOT.replace('k_velocity="3"', "")
    with pytest.raises(FormatError, match="'shoulder' <safety_controller> needs a k_velocity"):
        RobotFacts(fromstring(broken)).limits("shoulder")


