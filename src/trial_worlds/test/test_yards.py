"""Narrow yards and crossings: fields, ways, difficulty, worlds, and the air about the waffle."""

import math
import os
from pathlib import Path

import numpy as np
import pytest
from rospkg import RosPack

from bullet_sim.description import Collision, Cylinder, LinkDescription, ModelDescription
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xacro.files import expand
from bullet_sim.pose import Pose
from bullet_sim.world import World
from trial_worlds import crossing, yard
from trial_worlds.crossing import (
    AHEAD,
    APPROACH,
    PERSON_RADIUS,
    ROBOT_FRONT,
    ROBOT_SPEED,
    clearance,
    draw_crossing,
)
from trial_worlds.house import open_walls
from trial_worlds.yard import difficulty

RESOURCES = Resources.from_environment(os.environ, find_package=RosPack().get_path)


def cells(*rows: str) -> np.ndarray:
    return np.array([[letter == "#" for letter in row] for row in rows])


# --- fields


def test_neighbours_beyond_the_walls_count_and_those_beyond_the_ends_do_not():
    assert yard.neighbours(cells("...", "...", "...")).tolist() == [[3] * 3, [0] * 3, [3] * 3]
    assert yard.neighbours(cells(".#.", "...", "...", "...")).tolist()[1] == [1, 1, 1]


def test_crowds_fill_and_loners_go():
    alone = np.zeros((7, 7), bool)
    alone[3, 3] = True

    class Fixed:
        def random(self, shape):
            return np.where(alone, 0.0, 1.0)

    grown = yard.grow(Fixed(), 7, 7, 0.5, 1)
    assert grown[[0, -1]].all() and not grown[1:-1].any()


def test_the_robot_s_middle_keeps_its_reach_from_every_cylinder():
    closed = yard.blocked(cells(".......", ".......", "...#...", ".......", "......."), 1)
    assert np.array_equal(closed, cells(".......", "..###..", "..###..", "..###..", "......."))


def test_the_shortest_way_goes_round_and_never_through_a_corner():
    path = yard.shortest_path(cells("...", "##.", "..."), (0, 0), (2, 0))
    assert path.tolist() == [[0, 0], [0, 1], [1, 2], [2, 1], [2, 0]]
    assert yard.shortest_path(cells("..#", ".#.", "#.."), (0, 0), (2, 2)) is None


# --- difficulty


def test_measures_of_a_corridor():
    closed = cells("#######", ".......", ".......", ".......", "#######")
    path = np.array([[2, column] for column in range(7)])
    found = difficulty(closed, path)
    assert (found.closest_obstacle, found.tortuosity) == (2.0, 1.0)
    middle = difficulty(closed, np.array([[2, 3]]))
    assert middle.visibility == 2.0  # on six rays; two end at no obstacle
    assert middle.characteristic_dimension == 2.0


def test_dispersion_counts_changes_round_the_circle():
    open_ground, post = np.zeros((9, 9), bool), np.zeros((9, 9), bool)
    post[4, 6] = True
    here = np.array([[4, 4]])
    assert difficulty(open_ground, here).dispersion == 0
    assert difficulty(post, here).dispersion == 2


def test_a_detour_is_tortuous():
    path = np.array([[0, 0], [1, 1], [0, 2]])
    assert difficulty(np.zeros((3, 3), bool), path).tortuosity == pytest.approx(math.sqrt(2))


# --- yards


@pytest.mark.parametrize("seed", range(12))
def test_a_yard_is_shut_all_round_and_has_a_way_with_room_for_the_waffle(seed):
    found = yard.draw_yard(seed)
    assert np.array_equal(found.cells, yard.draw_yard(seed).cells)
    edge = [found.cells[[0, -1]], found.cells[:, [0, -1]]]
    assert all(side.all() for side in edge)
    for row, column in found.path:
        assert not found.cells[row - 2:row + 3, column - 2:column + 3].any()
    wide = min(clearance((x, y, turn), found.cylinders, yard.RADIUS)
               for x, y in yard.places(found.path) for turn in np.arange(0, 6.3, 0.7))
    assert wide > 0.02  # it may even turn on the spot anywhere on that way


def test_yards_and_their_starts_differ():
    first, second = yard.draw_yard(0), yard.draw_yard(12)
    assert (first.fill, first.smoothing) == (second.fill, second.smoothing)
    assert not np.array_equal(first.cells, second.cells)
    assert first.start(0)[1:] == (first.start(0)[1], 0.0)
    assert first.start(0) != first.start(1) != first.start(2)
    assert first.start(1) == first.start(1) != second.start(1)


def test_a_yard_is_to_the_waffle_what_the_benchmark_s_is_to_the_jackal():
    assert pytest.approx(0.15 / 0.430) == yard.CELL / 0.306
    straight = math.dist(yard.draw_yard(0).goal[:2], yard.draw_yard(0).start(0)[:2])
    assert straight == pytest.approx((yard.SIZE + 2 * yard.APRON - 1 - 2 * yard.MARGIN)
                                     * yard.CELL)


def test_the_world_file_has_its_cylinders_where_they_stand(tmp_path):
    found = yard.draw_yard(3)
    path = tmp_path / "worlds" / "yard_3.world"
    path.parent.mkdir()
    path.write_text(crossing.world(crossing.yard_model(found)))
    x, y = yard.places(found.path)[len(found.path) // 2]
    angles = np.arange(0, 2 * np.pi, 0.1)
    ways = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    start = np.full((len(angles), 3), (x, y, 0.13))
    end = start.copy()
    end[:, :2] += 5.0 * ways
    world = open_walls(path)
    ranges = world.cast_rays(start, end).fraction * 5.0
    world.close()
    away = found.cylinders - (x, y)
    for way, seen in zip(ways, ranges, strict=True):
        along, aside = away @ way, away @ (-way[1], way[0])
        hit = (along > 0) & (abs(aside) < yard.RADIUS)
        expected = (along[hit] - np.sqrt(yard.RADIUS ** 2 - aside[hit] ** 2)).min(initial=5.0)
        assert seen == pytest.approx(expected, abs=0.01)  # the engine's rays graze cylinders


# --- crossings


@pytest.mark.parametrize("seed", range(20))
def test_a_person_comes_close_before_a_robot_that_drives_on(seed):
    walk = draw_crossing(seed)
    ways = np.arange(0.0, 2 * APPROACH, 0.01)
    person = np.array(walk.begin[:2]) + ways[:, None] * (math.cos(walk.heading),
                                                        math.sin(walk.heading))
    robot = walk.trigger + ROBOT_SPEED * ways / walk.speed
    at_line = np.abs(person[:, 1]).argmin()
    ahead = person[at_line, 0] - robot[at_line] - ROBOT_FRONT
    assert ahead == pytest.approx(walk.ahead, abs=0.01) and AHEAD[0] <= ahead <= AHEAD[1]
    assert walk.trigger > 0.3  # the robot is under way
    air = min(clearance((x, 0.0, 0.0), place[None], PERSON_RADIUS)
              for x, place in zip(robot, person, strict=True))
    assert -0.15 < air < AHEAD[1]
    walls = load_model(crossing.model("room"), RESOURCES).links[0].collisions
    places = np.array([wall.pose.position[:2] for wall in walls])
    for low, high, values in zip(places.min(0), places.max(0), person.T, strict=True):
        assert low + PERSON_RADIUS < values.min() and values.max() < high - PERSON_RADIUS


# --- air


@pytest.mark.parametrize(
    ("pose", "centre", "air"),
    [
        ((0.0, 0.0, 0.0), (0.273, 0.0), 0.1),
        ((0.0, 0.0, 0.0), (-0.397, 0.1), 0.1),
        ((0.0, 0.0, 0.0), (0.0, -0.353), 0.1),
        ((0.0, 0.0, 0.0), (-0.1, 0.333), math.hypot(0.067, 0.18) - 0.1),
        ((1.0, 2.0, math.pi / 2), (1.0, 2.273), 0.1),
        ((0.0, 0.0, 0.0), (0.073, 0.0), -0.1),
    ],
)
def test_air_between_the_waffle_and_a_cylinder(pose, centre, air):
    assert clearance(pose, np.array([centre, (9.0, 9.0)]), 0.1) == pytest.approx(air, abs=1e-9)


@pytest.fixture(scope="module")
def waffle_text():
    find = RosPack().get_path
    folder = Path(find("turtlebot3_description")) / "urdf"
    return expand(folder / "turtlebot3_waffle.urdf.xacro", find_package=find)


def touches(waffle_text: str, heading: float, air: float) -> bool:
    """Whether the engine says that the waffle touches a cylinder with so much air between."""
    radius, way = 0.1, np.array([math.cos(heading), math.sin(heading)])
    far = np.arange(0.1, 0.6, 0.0005)[:, None] * way
    left = np.array([clearance((0.0, 0.0, 0.0), place[None], radius) for place in far])
    x, y = far[np.abs(left - air).argmin()]
    post = Collision("post", Cylinder(radius, 0.5))
    world = World()
    world.spawn(ModelDescription("post", static=True, links=(
        LinkDescription("post", Pose((x, y, 0.25)), collisions=(post,)),)))
    world.spawn(load_model(waffle_text, RESOURCES), Pose(), "waffle")
    world.step(3)
    names = [(each.collision1, each.collision2) for each in world.contacts()]
    world.close()
    return any("post" in first + second for first, second in names)


@pytest.mark.parametrize("heading", [0.0, 0.4, 1.57, 2.2, 2.6, 3.14, 4.5, 5.2])
def test_the_engine_says_the_same_of_what_touches(waffle_text, heading):
    assert touches(waffle_text, heading, -0.002)
    assert not touches(waffle_text, heading, 0.003)


def test_a_person_in_the_simulator_is_as_wide_as_judged():
    (body,) = load_model(crossing.model("person"), RESOURCES).links
    assert body.collisions[0].geometry.radius == PERSON_RADIUS


def test_an_empty_room_is_all_air():
    assert clearance((0.0, 0.0, 0.0), np.empty((0, 2)), 0.1) == math.inf
