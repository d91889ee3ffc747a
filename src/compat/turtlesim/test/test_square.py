"""draw_square's law on the pond's own turtle; needs no master."""

import math
from collections import deque
from itertools import pairwise

import pytest
from turtlesim.pond.canvas import Canvas
from turtlesim.pond.pond import TICK, Turtle
from turtlesim.square import SIDE, SPEED, STOPPED, TURN_RATE, SquareDriver

LIMIT_TICKS = int(120 / TICK)


def corners_driven(turtle, number, late_ticks):
    """(x, y) where the turtle stood at each new goal's beginning, and all commands sent."""
    canvas, driver = Canvas((0, 0, 0)), SquareDriver(*turtle.place, turtle.theta)
    commands, places, sent, goal = deque([(0.0, 0.0)] * late_ticks), [turtle.place], [], driver.goal
    for tick in range(LIMIT_TICKS):
        moving = max(turtle.speed, abs(turtle.turn_rate)) > STOPPED
        commands.append(driver.update(*turtle.place, turtle.theta, moving))
        sent.append(commands[-1])
        forward, turn = commands.popleft()
        turtle.command(forward, 0.0, turn, tick * TICK)
        turtle.step(tick * TICK, canvas)
        if driver.goal is not goal:
            goal = driver.goal
            places.append(turtle.place)
            if len(places) > 2 * number:
                return places[::2], sent
    raise AssertionError(f"only {places}")


@pytest.mark.parametrize("late_ticks", [0, 1, 4])
@pytest.mark.parametrize("theta", [0.0, 2.5, -3.0])
def test_the_square_closes(theta, late_ticks):
    corners, _ = corners_driven(Turtle(5.5, 5.5, theta, 0), 12, late_ticks)  # three times round
    for lap in range(1, 4):
        assert math.dist(corners[4 * lap], corners[0]) < 0.01
    for here, there in pairwise(corners):
        assert math.dist(here, there) == pytest.approx(SIDE, abs=0.01)
    across = math.dist(corners[0], corners[2])
    assert across == pytest.approx(SIDE * math.sqrt(2), abs=0.01)


def test_speeds_are_upstreams():
    _, sent = corners_driven(Turtle(5.5, 5.5, 0.0, 0), 4, 1)
    assert max(forward for forward, _ in sent) == SPEED == 1.0
    assert max(turn for _, turn in sent) == TURN_RATE == 0.4
    assert all(forward == 0.0 or turn == 0.0 for forward, turn in sent)


def test_the_first_goal_is_straight_ahead():
    driver = SquareDriver(1.0, 1.0, math.pi / 2)
    assert (driver.goal.x, driver.goal.y) == pytest.approx((1.0, 3.0))
