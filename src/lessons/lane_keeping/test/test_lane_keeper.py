"""The lane keeper's memory: people at the zebra, a lost lane, pictures that cannot be trusted."""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawn_lane import Person, draw
from lane_keeping import lane_keeper
from lane_keeping.annotate import annotate
from lane_keeping.lane_keeper import LaneKeeper
from lane_keeping.settings import METHODS, load_settings

SETTINGS = load_settings(Path(__file__).parents[1] / "config" / "lane_keeping.yaml")
FRAME = 1 / 15  # s
FRONT = SETTINGS.robot_front


def approach(people, start=1.9, seconds=4.0, keeper=None):
    """Drive towards a zebra that begins `start` m ahead; the way driven and the last decision.

    people: a function of the time that gives the people by their place beyond the zebra's edge.
    """
    keeper, way = keeper or LaneKeeper(SETTINGS), 0.0
    for frame in range(round(seconds / FRAME)):
        edge, now = start - way, frame * FRAME
        there = [replace(one, ahead=one.ahead + edge) for one in people(now)]
        image = draw(SETTINGS, zebra=(edge, edge + 0.8), people=there, seed=frame)
        decision = keeper.step(image, now)
        way += decision.speed * FRAME
        yield now, start - way, decision


def test_it_stops_before_a_zebra_with_somebody_on_it_and_goes_on():
    gone = 2.2  # s
    rows = list(approach(lambda now: [Person(0.4, 0.1 if now < gone else 2.0)], seconds=3.5))
    standing = [edge for now, edge, decision in rows if decision.speed == 0]
    assert standing[0] - FRONT == pytest.approx(SETTINGS.zebra_gap, abs=0.05)
    before = [decision for now, _, decision in rows if now < gone]
    assert before[-1].state == lane_keeper.PERSON and before[-1].turn == 0
    starts = [now for now, _, decision in rows if now > gone and decision.speed > 0.1]
    assert starts[0] - gone < 0.5


def test_it_passes_slowly_whoever_waits():
    rows = list(approach(lambda now: [Person(0.4, -0.95)], seconds=1.0))
    speeds = [decision.speed for _, edge, decision in rows if edge > FRONT + 0.4]
    assert set(speeds) == {SETTINGS.waiting_speed}


def test_who_stands_on_the_kerb_does_not_stop_a_robot_that_is_on_the_zebra():
    keeper = LaneKeeper(SETTINGS)
    keeper.step(draw(SETTINGS, zebra=(0.5, 1.3)), 0.0)
    for frame in range(1, 12):
        edge = 0.5 - 0.04 * frame
        people = [Person(edge + 0.8, 0.6)] if edge < FRONT else ()
        image = draw(SETTINGS, zebra=(edge, edge + 0.8), people=people)
        decision = keeper.step(image, frame * FRAME)
    assert edge < FRONT and decision.state == lane_keeper.LANE and decision.speed > 0


def test_it_stops_for_somebody_on_the_lane_without_a_zebra():
    decision = LaneKeeper(SETTINGS).step(draw(SETTINGS, people=[Person(0.75, 0.0)]), 0.0)
    assert (decision.state, decision.speed, decision.turn) == (lane_keeper.PERSON, 0, 0)
    far = LaneKeeper(SETTINGS).step(draw(SETTINGS, people=[Person(1.2, 1.0)]), 0.0)
    assert far.speed == SETTINGS.straight_speed


@pytest.mark.parametrize("light", [0.6, 1.4])
def test_an_empty_zebra_changes_nothing(light):
    for near in (0.3, 0.6, 1.0, 1.6):
        image = draw(SETTINGS, zebra=(near, near + 0.8), light=light, noise=0.01)
        decision = LaneKeeper(SETTINGS).step(image, 0.0)
        assert decision.speed == SETTINGS.straight_speed and abs(decision.turn) < 0.03


def test_a_lost_lane_is_driven_on_then_looked_for_then_given_up():
    keeper, bare = LaneKeeper(SETTINGS), draw(SETTINGS, sides=())
    assert keeper.step(draw(SETTINGS, curvature=0.7), 0.0).turn > 0.2
    states = {}
    for frame in range(1, 80):
        bare = np.roll(bare, 1, axis=1)  # not frozen
        decision = keeper.step(bare, frame * FRAME)
        states.setdefault(decision.state, (frame * FRAME, decision))
    assert list(states) == [lane_keeper.LOST, lane_keeper.SEARCHING, lane_keeper.STOPPED]
    assert states["lost"][1].speed == SETTINGS.bend_speed and states["lost"][1].turn > 0.2
    assert states["searching"][0] == pytest.approx(SETTINGS.lost_time, abs=0.08)
    assert states["searching"][1].speed == 0
    assert states["searching"][1].turn == SETTINGS.search_turn  # to the left, as the bend led
    assert states["stopped"][0] == pytest.approx(SETTINGS.lost_time + SETTINGS.search_time, abs=0.1)
    assert decision.speed == decision.turn == 0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("size", [(80, 60), (101, 333), (1280, 720)])
def test_pictures_of_any_size_and_content_give_a_finite_command(method, size):
    random, keeper = np.random.default_rng(2), LaneKeeper(replace(SETTINGS, method=method))
    for frame, image in enumerate((draw(SETTINGS, size=size),
                                   random.integers(0, 255, (size[1], size[0], 3), np.uint8))):
        decision = keeper.step(image, frame * FRAME)
        assert np.isfinite([decision.speed, decision.turn]).all()
        annotate(image, decision)


def test_blank_and_frozen_pictures_stop_it():
    keeper, image = LaneKeeper(SETTINGS), draw(SETTINGS)
    assert keeper.step(image, 0.0).speed > 0
    blank = keeper.step(np.full_like(image, 80), FRAME)
    assert (blank.state, blank.speed, blank.turn) == (lane_keeper.BLANK, 0, 0)
    decisions = [keeper.step(image, 1 + frame * FRAME) for frame in range(15)]
    assert decisions[0].speed > 0 and decisions[-1].state == lane_keeper.FROZEN
    assert decisions[-1].speed == decisions[-1].turn == 0
    stamps_stand = LaneKeeper(SETTINGS)
    for frame in range(15):
        decision = stamps_stand.step(image, 7.0, now=frame * FRAME)
    assert decision.state == lane_keeper.FROZEN


def test_time_that_is_set_back_is_no_trouble():
    keeper = LaneKeeper(SETTINGS)
    keeper.step(draw(SETTINGS, zebra=(1.0, 1.8), people=[Person(1.4, 0.0)]), 100.0)
    for frame in range(10):
        decision = keeper.step(draw(SETTINGS, seed=frame, noise=0.01), frame * FRAME)
    assert (decision.state, decision.speed) == (lane_keeper.LANE, SETTINGS.straight_speed)


@pytest.mark.parametrize("stamp", [0.0, 7.0])
def test_a_camera_whose_stamps_stand_still_does_not_let_it_drive_without_a_lane(stamp):
    keeper, bare = LaneKeeper(SETTINGS), draw(SETTINGS, sides=())
    assert keeper.step(draw(SETTINGS), stamp, now=5.0).state == lane_keeper.LANE
    for frame in range(1, 20):
        decision = keeper.step(np.roll(bare, frame, axis=1), stamp, now=5.0 + frame * FRAME)
        assert decision.state != lane_keeper.LANE
    assert decision.speed == 0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("hfov", [0.3, 1.4])
def test_a_camera_that_looks_up_is_no_trouble(method, hfov, recwarn):
    up = replace(SETTINGS, method=method, camera_pitch=-0.3, camera_hfov=hfov)
    keeper, image = LaneKeeper(up), np.full((240, 320, 3), 150, np.uint8)
    for frame, half in enumerate((slice(0, 160), slice(150, 170), slice(280, 320))):
        picture = image.copy()
        picture[:, half] = 20
        annotate(picture, keeper.step(picture, 1 + frame * FRAME))
    assert not recwarn.list


def test_drawing_leaves_every_state_drawn_in_little_time():
    image = draw(SETTINGS, zebra=(1.0, 1.8), people=[Person(1.4, 0.0)])
    spent = []
    for _ in range(9):
        began = time.thread_time()
        decision = LaneKeeper(SETTINGS).step(image, 0.0)
        drawn = annotate(image.copy(), decision)
        spent.append(time.thread_time() - began)
    assert np.count_nonzero((drawn != image).any(axis=2)) > 2000
    assert min(spent) < 0.015  # s, of one core
    blank = np.zeros((480, 640, 3), np.uint8)
    assert annotate(blank, LaneKeeper(SETTINGS).step(blank, 0.0)).any()
