"""A grasp: two fingers that press a frictionless thing from opposite sides hold it."""

import pytest
from rigs import body, part, rig, slider

from bullet_sim.description import Surface, WorldDescription
from bullet_sim.mechanisms.grasp import Grasp, GraspParameters
from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import Pose
from bullet_sim.world import World

SLIPPERY = Surface(mu=0.0, mu2=0.0)
FINGER = (0.02, 0.04, 0.04)  # m


class Gripper:
    """Fingers left (-x) and right (+x) of a cube of 1 kg; the grasp is updated at 100 Hz."""

    def __init__(self, thing=None, fingers=("left", "right")):
        self.world = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
        ways = {"left": (slider("left", (1, 0, 0)), -0.062),
                "right": (slider("right", (-1, 0, 0)), 0.062)}
        links = tuple(part(f"{name}_link", Pose((ways[name][1], 0, 0)), FINGER, SLIPPERY)
                      for name in fingers)
        self.model = self.world.spawn(rig(*(ways[name][0] for name in fingers), links=links))
        self.thing = self.world.spawn(thing or body("thing", (0.1, 0.1, 0.1), surface=SLIPPERY))
        self.grasp = Grasp(self.world, self.model.links["base"],
                           [self.model.links[link.name] for link in links], GraspParameters())
        self.updates = 0

    def drive(self, speed: float) -> None:
        """Positive closes; m/s."""
        for joint in self.model.joints.values():
            joint.drive_velocity(speed, 5.0)

    def run(self, seconds: float, until=None, update: bool = True) -> bool:
        """Whether what was waited for is there."""
        for _ in range(round(seconds / 0.01)):
            self.world.step(10)
            if update:
                self.grasp.update()
            if until and until():
                return True
        return until is None

    def close_on_it(self) -> None:
        self.drive(0.1)
        assert self.run(1.0, lambda: self.grasp.held)

    def fallen(self, update: bool = True) -> float:
        """How far the thing falls within 0.2 s, m."""
        height = self.thing.pose.position[2]
        self.world.configure_physics(gravity=(0.0, 0.0, -9.8))
        self.run(0.2, update=update)
        return height - self.thing.pose.position[2]


@pytest.fixture
def make():
    made = []

    def gripper(*args, **options) -> Gripper:
        made.append(Gripper(*args, **options))
        return made[-1]

    yield gripper
    for one in made:
        one.world.close()


def test_what_is_gripped_for_a_while_does_not_fall(make):
    gripper = make()
    gripper.close_on_it()
    assert gripper.grasp.held is gripper.thing.links["l"]
    assert gripper.fallen() == pytest.approx(0.0, abs=5e-3)


def test_without_a_grasp_it_falls_between_the_fingers(make):
    gripper = make()
    gripper.drive(0.1)
    gripper.run(0.2, update=False)
    assert gripper.fallen(update=False) == pytest.approx(9.8 * 0.2**2 / 2, abs=0.03)


def test_a_grip_is_counted_before_it_holds(make):
    gripper = make()
    gripper.drive(0.1)
    gripper.run(0.2, update=False)
    for _ in range(5):
        gripper.grasp.update()
        assert gripper.grasp.held is None
    gripper.grasp.update()
    assert gripper.grasp.held


@pytest.mark.parametrize("left, right, held", [
    ((2.0, 0.0, 0.0), (-2.0, 0.0, 0.0), True), ((2.0, 0.0, 0.0), (-0.61, 0.0, 0.0), True),
    ((2.0, 0.0, 0.0), (-0.59, 0.0, 0.0), False), ((2.0, 0.0, 0.0), (0.0, 0.0, 0.0), False),
    ((2.0, 0.0, 0.0), (-2.0, 3.0, 0.0), True), ((2.0, 0.0, 0.0), (-2.0, 4.0, 0.0), False),
    ((2.0, 0.0, 0.0), (2.0, 0.0, 0.0), False)])
def test_only_forces_against_each_other_are_a_grip(make, monkeypatch, left, right, held):
    gripper = make()
    gripper.drive(0.1)
    gripper.run(0.2, update=False)
    forces = {"left_link": left, "right_link": right}
    touches = [Contact(f"rig::{name}::c", "thing::l::c", (0, 0, 0), (1, 0, 0), 0.0, force)
               for name, force in forces.items()]
    monkeypatch.setattr(gripper.world, "contacts", lambda: touches)
    for _ in range(6):
        gripper.grasp.update()
    assert (gripper.grasp.held is not None) is held


def test_open_fingers_let_fall(make):
    gripper = make()
    gripper.close_on_it()
    gripper.drive(-0.1)
    assert gripper.run(0.5, lambda: gripper.grasp.held is None)
    assert gripper.fallen() == pytest.approx(9.8 * 0.2**2 / 2, abs=0.03)


def test_a_finger_that_has_hardly_moved_does_not_let_go(make):
    gripper = make()
    gripper.close_on_it()
    gripper.drive(0.0)
    for joint in gripper.model.joints.values():
        joint.reset(joint.position - 0.003)  # within the tolerance of 5 mm
    gripper.run(0.3)
    assert gripper.grasp.held
    for joint in gripper.model.joints.values():
        joint.reset(joint.position - 0.003)
    assert gripper.run(0.1, lambda: gripper.grasp.held is None)


def test_what_is_held_can_be_deleted(make):
    gripper = make()
    gripper.close_on_it()
    gripper.world.delete("thing")
    gripper.grasp.update()
    assert gripper.grasp.held is None


@pytest.mark.parametrize("options", [
    {"fingers": ("left",)},
    {"thing": body("wall", (0.1, 0.1, 0.1), static=True)},
])
def test_one_finger_and_what_is_static_are_no_grip(make, options):
    gripper = make(**options)
    gripper.drive(0.1)
    gripper.run(0.3)
    assert any("left_link" in link for contact in gripper.world.contacts()
               for link in contact.links) or "fingers" in options
    assert gripper.grasp.held is None
