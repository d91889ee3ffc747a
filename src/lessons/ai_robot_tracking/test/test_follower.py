"""The follower in a closed loop: its commands move a car, drawn pictures show what it then sees."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from ai_robot_tracking.follower import (
    FOLLOWING,
    SEARCHING,
    WAITING,
    Follower,
    FollowerSettings,
)
from drawn_room import HFOV, ORANGE, draw_cylinder, room
from node_basics.settings import load_settings

CONFIG = Path(__file__).resolve().parents[1] / "config" / "tracking_params.yaml"
SETTINGS = load_settings(FollowerSettings, CONFIG, "visual_tracker_pid", {})
PERIOD = 1 / 15  # s
WANTED = SETTINGS.wanted_distance


class Chase:
    """A car without inertia and a cylinder that walks; m, rad, s."""

    def __init__(self, target, settings=SETTINGS):
        self.follower, self.target = Follower(settings), np.array(target, float)
        self.pose, self.time, self.command = np.zeros(3), 0.0, (0.0, 0.0)
        self.others = []  # (x, y, colour) of further cylinders
        self.hidden = False

    def polar(self, place):
        away = np.asarray(place) - self.pose[:2]
        bearing = math.atan2(away[1], away[0]) - self.pose[2]
        return float(np.hypot(*away)), math.remainder(bearing, math.tau)

    @property
    def distance(self):
        return self.polar(self.target)[0]

    def step(self, velocity=(0.0, 0.0)):
        picture = room()
        things = [(*place, colour) for *place, colour in self.others]
        if not self.hidden:
            things.append((*self.target, (0, 0, 200)))
        for x, y, colour in sorted(things, key=lambda thing: -self.polar(thing[:2])[0]):
            distance, bearing = self.polar((x, y))
            if abs(bearing) < HFOV / 2 + 0.2 and distance > 0.3:
                draw_cylinder(picture, distance, bearing, colour)
        speed, turn = self.command = self.follower.drive(picture, self.time)
        self.pose += PERIOD * np.array([speed * math.cos(self.pose[2]),
                                        speed * math.sin(self.pose[2]), turn])
        self.target += PERIOD * np.array(velocity)
        self.time += PERIOD

    def run(self, seconds, velocity=(0.0, 0.0)):
        for _ in range(round(seconds / PERIOD)):
            self.step(velocity)


def test_comes_to_its_distance_and_stays():
    chase = Chase((3.0, 1.0))
    chase.run(8)
    assert chase.distance == pytest.approx(WANTED, abs=0.05)
    assert abs(chase.command[0]) < 0.05
    assert chase.follower.state == FOLLOWING


@pytest.mark.parametrize("velocity", [(0.3, 0.0), (-0.3, 0.0), (0.0, 0.3), (0.2, -0.2)])
def test_follows_what_walks_and_backs_away_from_what_comes(velocity):
    chase = Chase((WANTED, 0.0))
    chase.run(1.5, velocity)
    for _ in range(60):
        chase.step(velocity)
        assert chase.distance == pytest.approx(WANTED, abs=0.25)


@pytest.mark.parametrize("side", [1, -1])
def test_searches_where_it_was_last(side):
    chase = Chase((WANTED, 0.0))
    chase.run(3, (0.0, 0.3 * side))
    chase.hidden = True
    chase.run(0.2)
    assert (chase.follower.state, chase.command) == (WAITING, (0.0, 0.0))
    chase.run(0.5)
    assert chase.follower.state == SEARCHING
    assert chase.command == (0.0, pytest.approx(side * SETTINGS.search_turn))
    chase.run(2.0)
    assert chase.command[1] == pytest.approx(-side * SETTINGS.search_turn)  # then the other way


def test_finds_it_again_after_it_was_hidden_for_3_s():
    chase = Chase((WANTED, 0.0))
    chase.run(2, (0.1, 0.25))
    chase.hidden = True
    chase.run(3, (0.1, 0.25))
    chase.hidden = False
    chase.run(6, (0.1, 0.25))
    assert chase.follower.state == FOLLOWING
    assert chase.distance == pytest.approx(WANTED, abs=0.25)


def test_keeps_to_its_own_cylinder_among_others():
    chase = Chase((WANTED, 0.0))
    chase.others = [(2.5, -0.8, (0, 0, 200)), (1.0, 0.9, ORANGE)]
    chase.run(6, (0.0, 0.2))
    assert chase.distance == pytest.approx(WANTED, abs=0.25)
    assert chase.target[1] > 1.0


def test_a_change_of_settings_counts_at_once():
    chase = Chase((WANTED, 0.0))
    chase.run(1)
    chase.follower.settings = replace(SETTINGS, wanted_distance=2.0)
    chase.run(6)
    assert chase.distance == pytest.approx(2.0, abs=0.05)


def test_after_a_halt_nothing_old_is_left():
    chase = Chase((3.0, 0.0))
    chase.run(1)
    chase.follower.halt()
    chase.time += 10
    chase.step()
    assert abs(chase.command[1]) < 0.3
    assert chase.command[0] <= SETTINGS.max_speed
