"""Robots on more supports than three: every one of them carries, and the wheels drive."""

import math

import pytest

from bullet_sim.formats import Resources, load_model, load_world
from bullet_sim.world import World

WHEEL_RADIUS, SEPARATION = 0.05, 0.24  # m
WORLD = """<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri></include>
</world></sdf>"""


def part(name: str, pose: str, shape: str, mass: float, mu: float = 1.0) -> str:
    """A link with one collision."""
    inertia = 0.4 * mass * 0.05 ** 2
    return f"""<link name="{name}"><pose>{pose}</pose><inertial><mass>{mass}</mass><inertia>
      <ixx>{inertia}</ixx><iyy>{inertia}</iyy><izz>{inertia}</izz></inertia></inertial>
      <collision name="c"><geometry>{shape}</geometry><surface><friction><ode><mu>{mu}</mu>
      <mu2>{mu}</mu2></ode></friction></surface></collision></link>"""


def robot(mu: float) -> str:
    """Two wheels, a caster before and one behind that slide with `mu`; heavier in front."""
    ball, tyre = "<sphere><radius>0.02</radius></sphere>", \
        f"<cylinder><radius>{WHEEL_RADIUS}</radius><length>0.03</length></cylinder>"
    links = part("base", "0.03 0 0.08 0 0 0", "<box><size>0.3 0.2 0.06</size></box>", 5.0)
    joints = ""
    for name, x in (("front", 0.13), ("back", -0.13)):
        links += part(name, f"{x} 0 0.02 0 0 0", ball, 0.05, mu)
        joints += f"""<joint name="{name}_joint" type="fixed"><parent>base</parent>
          <child>{name}</child></joint>"""
    for name, y in (("left", SEPARATION / 2), ("right", -SEPARATION / 2)):
        links += part(name, f"0 {y} {WHEEL_RADIUS} -1.5707963 0 0", tyre, 0.3)
        joints += f"""<joint name="{name}_joint" type="revolute"><parent>base</parent>
          <child>{name}</child><axis><xyz>0 0 1</xyz></axis></joint>"""
    return f'<sdf version="1.6"><model name="robot">{links}{joints}</model></sdf>'


@pytest.fixture
def world(tmp_path):
    (tmp_path / "a.world").write_text(WORLD)
    made = World(load_world(tmp_path / "a.world", Resources.from_environment()))
    yield made
    made.close()


def drive(world, model, forward, turn, seconds=3.0):
    """Way (m) and angle (rad) that it goes when told to."""
    for name, side in (("left", -1), ("right", 1)):
        rim = forward + side * turn * SEPARATION / 2
        model.joints[f"{name}_joint"].drive_velocity(rim / WHEEL_RADIUS, 10.0)
    start, angle, last = model.pose.position, 0.0, model.pose.rpy()[2]
    for _ in range(round(seconds / 0.1)):
        world.step(100)
        now = model.pose.rpy()[2]
        angle += math.remainder(now - last, math.tau)
        last = now
    return math.dist(start[:2], model.pose.position[:2]), angle


@pytest.mark.parametrize("mu, least", [(0.0, 0.85), (1.0, 0.6)])
def test_it_drives_and_turns_although_it_stands_on_four(world, mu, least):
    model = world.spawn(load_model(robot(mu), Resources.from_environment()))
    world.step(1000)
    carried = {contact.collision1.split("::")[1]: contact.force[2] for contact in world.contacts()}
    assert set(carried) == {"left", "right", "front", "back"}
    assert sum(c.force[2] for c in world.contacts()) == pytest.approx(5.7 * 9.8, rel=0.02)
    assert drive(world, model, 0.3, 0.0)[0] > least * 0.9
    assert drive(world, model, 0.0, 1.0)[1] > least * 3.0


def test_free_wheels_do_not_set_off_by_themselves(world):
    model = world.spawn(load_model(robot(1.0), Resources.from_environment()))
    world.step(5000)
    assert math.hypot(*model.pose.position[:2]) < 0.005
