"""Casters a little lower than the wheels: how deep they may be is the world's or theirs to say."""

import pytest
from dynamic_reconfigure.msg import Config, DoubleParameter

LOW = 5e-4  # m
WORLD = """<sdf version="1.6"><world name="default"><physics type="ode">
  <real_time_update_rate>0</real_time_update_rate><ode><constraints>
  <contact_surface_layer>{}</contact_surface_layer></constraints></ode></physics>
  <include><uri>model://ground_plane</uri></include></world></sdf>"""
DRIVE = dict(robotNamespace="/", leftJoint="left_joint", rightJoint="right_joint",
             wheelSeparation=0.4, wheelDiameter=0.2)


@pytest.fixture
def speed(robots):
    """`speed(bench, text)`: m/s, of what was told to drive 0.3 m/s a second ago."""
    def drive(bench, text):
        car = bench.spawn(text)
        bench.send("/cmd_vel", robots.command(0.3))
        bench.run(1.0)
        reached = car.twist.linear[0]
        bench.delete(car.name)
        return reached
    return drive


@pytest.fixture
def robot(robots):
    """SDF; `contact` comes into the surface of both casters."""
    def make(contact=""):
        text = robots.two_wheels(robots.plugin("libgazebo_ros_diff_drive.so", **DRIVE))
        low = text.replace(" 0 0.03 0 0 0</pose>", f" 0 {0.03 - LOW} 0 0 0</pose>")
        assert low.count(f"{0.03 - LOW}") == 2
        frictionless = "<mu2>0.0</mu2></ode></friction>"
        return low.replace(frictionless, f"{frictionless}<contact><ode>{contact}</ode></contact>")
    return make


def test_the_worlds_layer_lets_them_be(make_bench, robot, speed):
    # conforms: sdf physics/ode/constraints/contact_surface_layer
    assert speed(make_bench(WORLD.format(0.001)), robot()) == pytest.approx(0.3, rel=0.02)


def test_a_thinner_one_does_not(make_bench, robot, speed):
    # conforms: sdf physics/ode/constraints/contact_surface_layer
    assert speed(make_bench(WORLD.format(0.0002)), robot()) < 0.2


def test_it_counts_for_what_is_spawned_after_a_change(make_bench, robot, speed):
    # conforms: /gazebo reconfigure/contact_surface_layer
    bench = make_bench(WORLD.format(0.0))
    change = Config(doubles=[DoubleParameter("contact_surface_layer", 0.001)])
    bench.call("/gazebo/set_parameters", config=change)
    assert speed(bench, robot()) == pytest.approx(0.3, rel=0.02)


def test_an_sdf_collision_may_say_so_itself(make_bench, robot, speed):
    # conforms: sdf surface/contact/ode/min_depth
    bench = make_bench(WORLD.format(0.0))
    assert speed(bench, robot("<min_depth>0.0002</min_depth>")) < 0.2
    assert speed(bench, robot("<min_depth>0.001</min_depth>")) == pytest.approx(0.3, rel=0.02)


def urdf(extension: str) -> str:
    """The same robot; a link of each caster is lumped into the base."""
    def link(name: str, shape: str, mass: float) -> str:
        return f"""<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="0.01"
          iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>{shape}
          </geometry></collision></link>"""

    def joint(name: str, kind: str, place: str) -> str:
        return f"""<joint name="{name}_joint" type="{kind}"><parent link="base"/>
          <child link="{name}"/><origin xyz="{place}" rpy="-1.5707963 0 0"/><axis xyz="0 0 1"/>
          </joint>"""

    text = link("base", '<box size="0.3 0.2 0.06"/>', 5.0)
    for name, y in (("left", 0.2), ("right", -0.2)):
        text += link(name, '<cylinder radius="0.1" length="0.04"/>', 1.0)
        text += joint(name, "continuous", f"0 {y} 0")
    for name, x in (("front", 0.12), ("back", -0.12)):
        text += link(name, '<sphere radius="0.03"/>', 0.2)
        text += joint(name, "fixed", f"{x} 0 {-0.07 - LOW}")
        text += f'<gazebo reference="{name}"><mu1>0</mu1><mu2>0</mu2>{extension}</gazebo>'
    tags = "".join(f"<{tag}>{value}</{tag}>" for tag, value in DRIVE.items())
    return (f'<robot name="car">{text}<gazebo><plugin name="p" '
            f'filename="libgazebo_ros_diff_drive.so">{tags}</plugin></gazebo></robot>')


def test_so_may_a_urdf_link(make_bench, speed):
    # conforms: urdf gazebo@link/minDepth
    bench = make_bench(WORLD.format(0.0))
    assert speed(bench, urdf("")) < 0.2
    assert speed(bench, urdf("<minDepth>0.001</minDepth>")) == pytest.approx(0.3, rel=0.02)
