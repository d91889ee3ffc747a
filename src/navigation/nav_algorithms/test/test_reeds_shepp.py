"""Reeds-Shepp and Dubins curves: they arrive, and are as short as is known."""

import numpy as np
import pytest

from nav_algorithms.global_planning import reeds_shepp
from nav_algorithms.poses import wrap_angle


def end_of(word):
    pose = np.zeros(3)
    for length, curvature in word:
        yaw = pose[2] + length * curvature
        if curvature:
            pose[0] += (np.sin(yaw) - np.sin(pose[2])) / curvature
            pose[1] += (np.cos(pose[2]) - np.cos(yaw)) / curvature
        else:
            pose[:2] += length * np.array([np.cos(yaw), np.sin(yaw)])
        pose[2] = yaw
    return pose


def words_to(family, goal):
    words = np.zeros((reeds_shepp.WORDS, reeds_shepp.PIECES, 2))
    return words[:family(words, *map(float, goal))]


def shortest(family, goal):
    return min(np.abs(word[:, 0]).sum() for word in words_to(family, goal))


@pytest.mark.parametrize("family", [reeds_shepp.reeds_shepp, reeds_shepp.dubins])
def test_every_word_ends_at_the_goal(family):
    generator = np.random.default_rng(0)
    for _ in range(500):
        goal = generator.uniform([-5, -5, -np.pi], [5, 5, np.pi])
        found = words_to(family, goal)
        assert len(found)
        for word in found:
            end = end_of(word)
            assert end[:2] == pytest.approx(goal[:2], abs=1e-6)
            assert wrap_angle(end[2] - goal[2]) == pytest.approx(0.0, abs=1e-6)


def test_words_are_of_the_nine_families_of_reeds_and_shepp():
    """Of these the shortest drive is one.

    L is an arc to the side of the first one, R one to the other, S a straight, | a cusp.
    """
    found = set()
    for goal in np.random.default_rng(3).uniform([-5, -5, -np.pi], [5, 5, np.pi], (500, 3)):
        for word in words_to(reeds_shepp.reeds_shepp, goal):
            pieces = word[np.abs(word[:, 0]) > 1e-9]
            cusps = np.diff(np.sign(pieces[:, 0]), prepend=np.sign(pieces[0, 0])) != 0
            sides = {0.0: "S", pieces[0, 1]: "L", -pieces[0, 1]: "R"}
            found.add("".join(("|" if cusp else "") + sides[curvature]
                              for cusp, (_, curvature) in zip(cusps, pieces, strict=True)))
    assert found == {"LSL", "LSR", "L|R|L", "L|RL", "LR|L", "LR|LR", "L|RL|R", "L|RSL", "L|RSR",
                     "LSL|R", "LSR|L", "L|RSL|R"}


@pytest.mark.parametrize("goal, length", [
    ((5, 0, 0), 5), ((-5, 0, 0), 5), ((2, 0, np.pi), np.pi), ((0, 2, np.pi), np.pi)])
def test_known_shortest_drives(goal, length):
    assert shortest(reeds_shepp.reeds_shepp, goal) <= length + 1e-9
    if goal[0] == 5 or goal[1] == 2:
        assert shortest(reeds_shepp.reeds_shepp, goal) == pytest.approx(length)


@pytest.mark.parametrize("first", [1.0, -1.0])
@pytest.mark.parametrize("last", [1.0, -1.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_two_short_arcs_and_a_straight_are_the_shortest_drive(first, last, way):
    goal = end_of([(0.5 * way, first), (6.0 * way, 0.0), (0.4 * way, last)])
    assert shortest(reeds_shepp.reeds_shepp, goal) == pytest.approx(6.9)


def test_turning_round_on_the_spot_takes_three_arcs():
    assert shortest(reeds_shepp.reeds_shepp, (0, 0, np.pi)) == pytest.approx(np.pi)
    assert shortest(reeds_shepp.dubins, (0, 0, np.pi)) == pytest.approx(7 * np.pi / 3)


def test_lengths_are_those_of_the_way_back():
    generator = np.random.default_rng(1)
    for _ in range(200):
        x, y, yaw = generator.uniform([-4, -4, -np.pi], [4, 4, np.pi])
        back = (-x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) - y * np.cos(yaw), -yaw)
        assert shortest(reeds_shepp.reeds_shepp, (x, y, yaw)) == pytest.approx(
            shortest(reeds_shepp.reeds_shepp, back), abs=1e-6)


def test_dubins_only_goes_forwards():
    for goal in np.random.default_rng(2).uniform(-4, 4, (100, 3)):
        assert (words_to(reeds_shepp.dubins, goal)[:, :, 0] >= 0).all()
        assert shortest(reeds_shepp.reeds_shepp, goal) <= shortest(reeds_shepp.dubins, goal) + 1e-9


@pytest.mark.parametrize("way, three_arcs", [(1.0, True), (3.9, True), (4.1, False)])
def test_dubins_six_words_and_those_of_three_arcs_as_long_as_two_circles_reach(way, three_arcs):
    letters = {1.0: "L", 0.0: "S", -1.0: "R"}
    found = {"".join(letters[curvature] for curvature in word[:3, 1])
             for word in words_to(reeds_shepp.dubins, (way, 0.0, 0.0))}
    assert found == {"LSL", "RSR", "LSR", "RSL"} | ({"LRL", "RLR"} if three_arcs else set())
    with_cusps = [word for word in words_to(reeds_shepp.reeds_shepp, (way, 0.0, 0.0))
                  if np.sign(word[:, 0] * abs(word[:, 1])).tolist() == [1, -1, 1, 0, 0]]
    assert bool(with_cusps) == three_arcs
