"""House files, and what the true walls say: where there is room, goals, shortest ways."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from evaluation.house import load_house
from nav_algorithms.cells import OCCUPIED
from nav_algorithms.likelihood_field import distances
from run_session.failure import RunError
from trial_worlds.errors import WorldError

HOUSES = Path(__file__).parent.parent / "houses"
VALUES = yaml.safe_load((HOUSES / "house.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def ground():
    return load_house("house").ground()


def test_the_house_can_be_driven_through(ground):
    for point in VALUES["way_points"]:
        assert ground.has_room(np.array(point)), point
    assert not ground.has_room(np.array([-4.5, 0.0]))  # in a wall
    assert not ground.has_room(np.array([-4.3, 1.0]))  # too near to it
    assert not ground.has_room(np.array([50.0, 0.0]))


def test_goals_keep_away_from_walls_and_from_each_other(ground):
    goals = ground.draw_goals(30, seed=3)
    near = distances((ground.walls.cells == OCCUPIED).astype(np.uint8)) * ground.walls.resolution
    cells = ground.walls.cells_of(goals[:, :2])
    assert near[tuple(cells.T)].min() >= VALUES["goal_clearance"]
    way = np.vstack((VALUES["start"], goals))[:, :2]
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).min() >= VALUES["goal_distance"]
    assert np.abs(goals[:, :2]).max(axis=0) == pytest.approx([7.6, 5.2], abs=1.5)  # all rooms


def test_a_seed_draws_its_goals_again_and_a_shorter_list_is_the_beginning(ground):
    goals = ground.draw_goals(20, seed=1)
    assert (ground.draw_goals(5, seed=1) == goals[:5]).all()
    assert (ground.draw_goals(5, seed=2)[:, 2] != goals[:5, 2]).all()


def test_the_shortest_way_goes_through_doors(ground):
    free = ground.shortest_way(np.array([-3.0, 1.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    assert free == pytest.approx(3.0, rel=0.02)
    study, hall = np.array([-5.5, 0.5, 0.0]), np.array([-3.5, -1.5, 0.0])
    edge = np.array([-4.5, -1.5 - VALUES["passable"]])  # of the door between them, and room
    least = np.linalg.norm(study[:2] - edge) + np.linalg.norm(hall[:2] - edge)
    assert least < ground.shortest_way(study, hall) < 1.1 * least
    assert ground.shortest_way(study, np.array([-6.5, 4.0, 0.0])) == np.inf  # in the bed


@pytest.mark.parametrize("key, value, said", [
    ("way_points", [[1, 2, 3]], "a list of"), ("way_points", [], "a list of"),
    ("start", [0, 0], "x, y, yaw"), ("passable", 0, "above 0"), ("max_speed", ".26", "above 0"),
    ("model", 3, "a text"), ("goal_clearance", float("nan"), "above 0")])
def test_a_wrong_value_is_named_with_file_and_key(tmp_path, key, value, said):
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({**VALUES, key: value}))
    with pytest.raises(RunError, match=rf"mine\.yaml: {key}: must be .*{said}"):
        load_house(str(path))


@pytest.mark.parametrize("text, said", [
    ("[1]", "missing key"), ("world: [", "not valid YAML"),
    (yaml.safe_dump({**VALUES, "colour": 1}), "unknown key 'colour'")])
def test_a_broken_file_is_named(tmp_path, text, said):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    with pytest.raises(RunError, match=rf"mine\.yaml: {said}"):
        load_house(str(path))


def test_an_unknown_house_is_answered_with_those_there_are():
    with pytest.raises(RunError, match=r"no house 'hut' \(--house\); there are: house"):
        load_house("hut")


def test_a_world_that_is_not_there_is_named(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({**VALUES, "world": "/nowhere/at_all.world"}))
    with pytest.raises(WorldError, match=r"at_all\.world"):
        load_house(str(path)).ground()


def test_too_little_room_for_a_goal_is_said(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({**VALUES, "goal_clearance": 5.0}))
    with pytest.raises(WorldError, match="no room for a goal"):
        load_house(str(path)).ground().draw_goals(1, 0)
