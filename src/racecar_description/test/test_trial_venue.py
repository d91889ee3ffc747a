"""What the navigation trials are judged by: contacts with walls, clearances, paths."""

import numpy as np
import pytest
from racecar_in_world import PACKAGE, RESOURCES
from trial_record import turns_of_direction, way
from trial_venue import VENUES, Truth, prepare

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xacro.files import expand
from bullet_sim.pose import Pose
from bullet_sim.sensors.contact import ContactSensor
from bullet_sim.world import World

FIRST_WALL = {"walled": 0.545, "field": 0.8}  # m, to the right of the start line, its inner face


@pytest.fixture(scope="module", params=VENUES)
def venue(request, tmp_path_factory):
    return prepare(request.param, tmp_path_factory.mktemp(request.param))


def felt(venue, y):
    """What the walls feel of a car that stands at x = 1 m, y, m, after a tenth of a second."""
    resources = Resources.from_environment(
        extra_model_paths=[venue.models], extra_resource_paths=[PACKAGE],
        find_package=lambda name: str(PACKAGE))
    world = World(load_world(venue.world, resources))
    try:
        text = expand(PACKAGE / "urdf" / "racecar.urdf.xacro")
        world.spawn(load_model(text, RESOURCES), Pose.from_xyz_rpy((1.0, y, 0.0)), "racecar")
        link = next(link for model in world.models.values() for link in model.links.values()
                    if link.description.sensors)
        sensor = ContactSensor(world, link, link.description.sensors[0])
        for _ in range(100):
            world.step()
        return [pair.other for pair in sensor.sample()]
    finally:
        world.close()


def test_the_walls_feel_a_car_and_not_the_ground(venue):
    assert felt(venue, 0.0) == []
    touched = felt(venue, -(FIRST_WALL[venue.name] - 0.135))
    assert touched and all(name.startswith("racecar::") for name in touched)


def test_clearances(venue):
    truth = Truth(venue)
    ahead, nearer, in_the_wall, outside = truth.clearances(np.array(
        [[1.0, 0.0, 0.0], [1.0, -0.2, 0.0], [1.0, -FIRST_WALL[venue.name], 0.0], [50.0, 0, 0]]))
    assert ahead == pytest.approx(FIRST_WALL[venue.name] - 0.162, abs=0.03)
    assert nearer == pytest.approx(ahead - 0.2, abs=0.02)
    assert in_the_wall <= 0.03 and outside == 0.0


def test_paths():
    x = [0.0, 0.5, 1.0, 0.7, 0.7, 1.0]
    speed = [0.5, 0.5, 0.0, -0.3, 0.01, 0.3]
    truth = np.column_stack((np.arange(6), x, np.zeros((6, 2)), speed))
    assert way(truth) == pytest.approx(1.6)
    assert turns_of_direction(truth) == 2
