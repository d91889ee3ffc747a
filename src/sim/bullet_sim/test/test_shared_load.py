"""Robots on more supports than three: they stand still, their wheels drive, and turn as told."""

import math

import pytest

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.world import World

WORLD = """<sdf version="1.6"><world name="w"><physics type="ode"><ode><constraints>
<contact_surface_layer>{layer}</contact_surface_layer></constraints></ode></physics>
<include><uri>model://ground_plane</uri></include></world></sdf>"""


def part(name: str, pose: str, shape: str, mass: float, mu: float = 1.0, contact: str = "") -> str:
    """A link with one collision."""
    inertia = 0.4 * mass * 0.05 ** 2
    return f"""<link name="{name}"><pose>{pose}</pose><inertial><mass>{mass}</mass><inertia>
      <ixx>{inertia}</ixx><iyy>{inertia}</iyy><izz>{inertia}</izz></inertia></inertial>
      <collision name="c"><geometry>{shape}</geometry><surface><friction><ode><mu>{mu}</mu>
      <mu2>{mu}</mu2></ode></friction>{contact}</surface></collision></link>"""


def wheel(name: str, x: float, y: float, size: float, mass: float) -> str:
    """A wheel, 3 cm wide for a radius of 5, on its joint."""
    tyre = f"<cylinder><radius>{0.05 * size}</radius><length>{0.03 * size}</length></cylinder>"
    return part(name, f"{x * size} {y * size} {0.05 * size} -1.5707963 0 0", tyre, mass) + f"""
      <joint name="{name}_joint" type="revolute"><parent>base</parent><child>{name}</child>
      <axis><xyz>0 0 1</xyz></axis></joint>"""


class Robot:
    """Two wheels, casters that slide with `mu` and are `low` (m) too low; heavier in front."""

    def __init__(self, world, mu=0.0, low=0.0, mass=5.0, casters=(0.13, -0.13), contact=""):
        self.world = world
        size = (mass / 5.0) ** (1 / 3)
        self.radius, self.separation, self.torque = 0.05 * size, 0.24 * size, 0.4 * mass * size
        links = part("base", f"{0.03 * size} 0 {0.08 * size} 0 0 0",
                     f"<box><size>{0.3 * size} {0.2 * size} {0.06 * size}</size></box>", mass)
        for number, x in enumerate(casters):
            name = f"caster_{number}"
            links += part(name, f"{x * size} 0 {0.02 * size - low} 0 0 0",
                          f"<sphere><radius>{0.02 * size}</radius></sphere>", 0.01 * mass, mu,
                          contact)
            links += f"""<joint name="{name}_joint" type="fixed"><parent>base</parent>
              <child>{name}</child></joint>"""
        for name, y in (("left", 0.12), ("right", -0.12)):
            links += wheel(name, 0.0, y, size, 0.06 * mass)
        self.model = world.spawn(load_model(
            f'<sdf version="1.6"><model name="robot">{links}</model></sdf>',
            Resources.from_environment()))
        world.step(500)

    def command(self, forward, turn):
        for name, side in (("left", -1), ("right", 1)):
            rim = forward + side * turn * self.separation / 2
            self.model.joints[f"{name}_joint"].drive_velocity(rim / self.radius, self.torque)

    def drive(self, forward, turn, seconds=1.5):
        """Mean speed (m/s) and rate (rad/s) when told to, after half a second."""
        self.command(forward, turn)
        self.world.step(500)
        start, angle, last = self.model.pose.position, 0.0, self.model.pose.rpy()[2]
        for _ in range(round(seconds / 0.1)):
            self.world.step(100)
            now = self.model.pose.rpy()[2]
            angle += math.remainder(now - last, math.tau)
            last = now
        return math.dist(start[:2], self.model.pose.position[:2]) / seconds, angle / seconds


@pytest.fixture
def make_world(tmp_path):
    worlds = []

    def make(layer=0.001):
        (tmp_path / "a.world").write_text(WORLD.format(layer=layer))
        worlds.append(World(load_world(tmp_path / "a.world", Resources.from_environment())))
        return worlds[-1]

    yield make
    for world in worlds:
        world.close()


@pytest.mark.parametrize("low", [-1e-3, 0.0, 1e-4, 3e-4, 1e-3])
@pytest.mark.parametrize(("mass", "mu"), [(1.0, 0.1), (5.0, 0.0), (5.0, 1.0), (50.0, 0.1)])
def test_it_stands_drives_and_turns_with_casters_a_little_too_low(make_world, mass, mu, low):
    robot = Robot(make_world(), mu, low, mass)
    assert robot.drive(0.0, 0.0) == (pytest.approx(0.0, abs=1e-4), pytest.approx(0.0, abs=1e-4))
    assert robot.drive(0.3, 0.0) == (pytest.approx(0.3, rel=0.005), pytest.approx(0.0, abs=0.005))
    speed, rate = robot.drive(0.0, 1.0)
    assert rate == pytest.approx(1.0, rel=0.01)
    assert speed < 0.002


def test_casters_lower_than_the_layer_lift_the_wheels(make_world):
    assert Robot(make_world(), low=2e-3).drive(0.3, 0.0)[0] < 0.15
    assert Robot(make_world(layer=0.0), low=3e-4).drive(0.3, 0.0)[0] < 0.15


def test_a_caster_may_say_how_deep_it_may_be(make_world):
    deep = "<contact><ode><min_depth>0.001</min_depth></ode></contact>"
    robot = Robot(make_world(layer=0.0), low=3e-4, contact=deep)
    assert robot.drive(0.3, 0.0)[0] == pytest.approx(0.3, rel=0.01)


@pytest.mark.parametrize("mu", [0.0, 1.0])
@pytest.mark.parametrize("casters", [(0.13, -0.13), (0.13,)])
def test_free_wheels_do_not_set_off_by_themselves(make_world, mu, casters):
    world = make_world()
    robot = Robot(world, mu, casters=casters)
    start = robot.model.pose.position
    world.step(5000)
    assert math.dist(start, robot.model.pose.position) < 0.001


def test_each_of_four_wheels_carries(make_world):
    world = make_world()
    links = part("base", "0 0 0.08 0 0 0", "<box><size>0.3 0.2 0.06</size></box>", 10.0)
    for name, x, y in (("a", 0.1, 0.12), ("b", 0.1, -0.12), ("c", -0.1, 0.12), ("d", -0.1, -0.12)):
        links += wheel(name, x, y, 1.0, 0.3)
    world.spawn(load_model(f'<sdf version="1.6"><model name="cart">{links}</model></sdf>',
                           Resources.from_environment()))
    world.step(1000)
    carried = dict.fromkeys("abcd", 0.0)
    for contact in world.contacts():
        carried[contact.collision1.split("::")[1]] += contact.force[2]
    assert list(carried.values()) == pytest.approx([11.2 * 9.8 / 4] * 4, rel=0.05)
