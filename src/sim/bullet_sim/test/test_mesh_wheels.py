"""Wheels and casters that are meshes: they stand, roll and turn as the round shapes that they are.
"""

import math

import pytest
import trimesh

from bullet_sim.description import (
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LinkDescription,
    Mesh,
    ModelDescription,
    Plane,
    Surface,
    WorldDescription,
)
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.tyres import LEAST_CROWN, TREAD, crown, engine_shapes, find_tyre
from bullet_sim.pose import Pose
from bullet_sim.world import World

RADIUS, WIDTH, TRACK = 0.05, 0.02, 0.2  # m
BALL = 0.015  # m, radius of casters
LIGHT = Inertial(0.1, inertia=(1e-4, 0, 0, 1e-4, 0, 1e-4))
BASE = Inertial(2.0, inertia=(0.01, 0, 0, 0.01, 0, 0.01))
AXLE = (0.0, 1.0, 0.0)
LAID = Pose.from_xyz_rpy((0, 0, 0), (math.pi / 2, 0, 0))
FLOOR = ModelDescription("floor", static=True, links=(LinkDescription("link", collisions=(
    Collision("c", Plane((0.0, 0.0, 1.0), (9.0, 9.0)), surface=Surface(mu=100.0)),)),))


@pytest.fixture
def export(tmp_path):
    """`export(name, trimesh)`: a mesh from a file."""
    def write(name, shape):
        shape.export(tmp_path / f"{name}.stl")
        return Mesh(str(tmp_path / f"{name}.stl"))
    return write


@pytest.fixture
def tyre(export):
    """`tyre(corners)`: a disc about z."""
    return lambda corners: export(
        f"tyre{corners}", trimesh.creation.cylinder(RADIUS, WIDTH, sections=corners))


def link(shape, pose=Pose(), axis=AXLE, kind="continuous") -> PhysicsLink:
    """A link that turns about an axis, as the engine gets it."""
    return PhysicsLink("wheel", "wheel", LIGHT, [Collision("c", shape, pose)],
                       joint=JointDescription("j", kind, "base", "wheel", axis=axis))


def speeds(casters: tuple, wheel, forward: float, turn: float) -> tuple[float, float]:
    """m/s and rad/s of what was told to drive for 1 s, wheels and casters being these shapes."""
    grip, slippery = Surface(mu=1.0, mu2=1.0), Surface(mu=0.0, mu2=0.0)
    links = [LinkDescription("base", pose=Pose((0, 0, RADIUS)), inertial=BASE)]
    joints = []
    for name, y in (("left", TRACK / 2), ("right", -TRACK / 2)):
        links.append(LinkDescription(name, pose=Pose((0, y, RADIUS)), inertial=LIGHT,
                                     collisions=(Collision("c", wheel, LAID, grip),)))
        joints.append(JointDescription(name, "continuous", "base", name, axis=AXLE))
    for name, x, (kind, shape) in (("front", 0.08, casters), ("back", -0.08, casters)):
        links.append(LinkDescription(name, pose=Pose((x, 0, BALL)), inertial=LIGHT,
                                     collisions=(Collision("c", shape, surface=slippery),)))
        joints.append(JointDescription(name, kind, "base", name, axis=AXLE))
    world = World(WorldDescription(models=(FLOOR,)))
    car = world.spawn(ModelDescription("car", links=tuple(links), joints=tuple(joints)))
    drive = DiffDrive(car.joints["left"], car.joints["right"],
                      DiffDriveParameters(TRACK, 2 * RADIUS))
    drive.command(forward, turn)
    drive.update(0.01)
    world.step(500)
    start = car.pose
    world.step(500)
    moved = start.inverse() * car.pose
    world.close()
    return moved.position[0] / 0.5, moved.rpy()[2] / 0.5


@pytest.mark.parametrize("kind", ["fixed", "continuous"])
@pytest.mark.parametrize("corners", [24, 64])
def test_a_robot_of_meshes_drives_and_turns_as_told(export, tyre, kind, corners):
    ball = export("ball", trimesh.creation.icosphere(subdivisions=2, radius=BALL))
    forward, _ = speeds((kind, ball), tyre(corners), 0.2, 0.0)
    _, turn = speeds((kind, ball), tyre(corners), 0.0, 1.0)
    assert (forward, turn) == (pytest.approx(0.2, rel=0.01), pytest.approx(1.0, rel=0.01))


@pytest.mark.parametrize("corners", [10, 32])
def test_a_round_mesh_has_a_tread_and_is_a_little_smaller_itself(tyre, corners):
    mesh = tyre(corners)
    made = link(mesh, LAID)
    tread, shoulders = engine_shapes(made)
    less = crown(made, find_tyre(made, made.collisions[0]))
    assert tread.geometry == Cylinder(pytest.approx(RADIUS, rel=1e-5), TREAD)
    assert tread.pose.transform((0, 0, 1)) == pytest.approx(AXLE)
    assert shoulders.geometry.scale == pytest.approx([1.0 - less / RADIUS] * 3, rel=1e-5)


def test_the_tread_is_on_the_rim_wherever_the_mesh_has_its_origin(export):
    wheel = trimesh.creation.cylinder(RADIUS, WIDTH, sections=32)
    hub = trimesh.creation.cylinder(RADIUS / 4, 0.1, sections=32)
    hub.apply_translation((0, 0, 0.05))  # all on one side
    both = trimesh.util.concatenate([wheel, hub])
    both.apply_translation((0.3, 0.2, -0.5))
    made = link(export("both", both), LAID * Pose((-0.3, -0.2, 0.5)))
    tread, shoulders = engine_shapes(made)
    assert tread.pose.position == pytest.approx((0, 0, 0), abs=1e-6)
    assert find_tyre(made, made.collisions[0]).width == pytest.approx(0.1 + WIDTH / 2)
    # About the tread's middle, and wide: its shoulders may keep a robot upright.
    smaller = 1.0 - LEAST_CROWN / RADIUS
    middle = shoulders.pose.transform(tuple(smaller * each for each in (0.3, 0.2, -0.5)))
    assert middle == pytest.approx((0, 0, 0), abs=1e-6)


def test_the_tread_is_in_the_middle_of_what_reaches_the_ground(export):
    wheel = trimesh.creation.cylinder(RADIUS, 0.01, sections=32)
    flange = trimesh.creation.cylinder(0.97 * RADIUS, 0.04, sections=32)
    flange.apply_translation((0.0, 0.0, 0.025))  # beside it
    made = link(export("both", trimesh.util.concatenate([wheel, flange])), LAID)
    assert find_tyre(made, made.collisions[0]).middle.position == pytest.approx((0, 0, 0), abs=1e-6)


@pytest.mark.parametrize("shape, aside", [
    (Cylinder(0.006, WIDTH), 0.0), (Cylinder(RADIUS, WIDTH), 5e-4)])
def test_small_wheels_and_those_that_are_hardly_off_their_axle_are_wheels(shape, aside):
    made = link(shape, LAID * Pose((aside, 0.0, 0.0)))
    assert len(list(engine_shapes(made))) == 2


def test_a_wheel_beside_its_links_origin_gets_smaller_about_its_own_middle(tyre):
    beside = LAID * Pose((0.0, 0.0, 0.3))
    tread, shoulders = engine_shapes(link(tyre(32), beside))
    assert tread.pose.position == pytest.approx(beside.position)
    assert shoulders.pose.position == pytest.approx(beside.position)


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, -2, 0)])
def test_a_tread_lies_along_any_axis(export, axis):
    disc = trimesh.creation.cylinder(RADIUS, WIDTH, sections=32)
    disc.apply_transform(trimesh.geometry.align_vectors((0, 0, 1), axis))
    tread, _ = engine_shapes(link(export("disc", disc), axis=axis))
    along = tread.pose.transform((0, 0, 1))
    length = math.hypot(*axis)
    assert abs(sum(a * b for a, b in zip(along, axis, strict=True))) == pytest.approx(length)


def test_what_is_not_round_about_the_axis_is_left_alone(export, tyre):
    wire = trimesh.Trimesh([(0, 0, 0), (0, 0, 0.1), (0, 0, 0.2)], [(0, 1, 2)], process=False)
    cases = [
        link(export("wire", wire), axis=(0.0, 0.0, 1.0)),  # no breadth
        link(tyre(9), LAID),  # a corner and a side differ by 6 %
        link(Cylinder(0.004, WIDTH), LAID),  # too small
        link(Cylinder(RADIUS, WIDTH), LAID * Pose((0.0015, 0.0, 0.0))),
        link(tyre(32), LAID, axis=(1.0, 0.0, 0.0)),
        link(tyre(32), LAID * Pose((0.01, 0.0, 0.0))),
        link(tyre(32), LAID, kind="fixed"),
        link(export("thin", trimesh.creation.cylinder(RADIUS, TREAD / 2)), LAID),
        link(Mesh("/nowhere/wheel.stl"), LAID),
    ]
    for case in cases:
        assert list(engine_shapes(case)) == case.collisions
