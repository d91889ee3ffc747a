"""One turtle against upstream's rules and numbers; needs no master."""

import math

import numpy as np
import pytest
from turtlesim.pond.canvas import SIDE, Canvas
from turtlesim.pond.pond import TICK, Turtle

BACKGROUND = (69, 86, 255)
PEN = (179, 184, 255)
RED = (255, 0, 0)


@pytest.fixture
def canvas():
    return Canvas(BACKGROUND)


@pytest.fixture
def turtle():
    return Turtle(5.0, 5.0, 0.0, look=0)


def drawn(canvas):
    """(row, column) of every pixel that is not background, with its colour."""
    places = np.argwhere((canvas.pixels != BACKGROUND).any(axis=2))
    return {tuple(place): tuple(canvas.pixels[tuple(place)]) for place in places.tolist()}


def test_the_world_is_499_pixels_of_45_to_the_metre():
    assert pytest.approx(11.0889, abs=1e-4) == SIDE


def test_a_tick_is_16_ms_of_motion_however_long_it_took(turtle, canvas):
    turtle.command(1.0, 0.0, 0.0, now=0.0)
    turtle.step(0.9, canvas)
    assert turtle.place == pytest.approx((5.016, 5.0))


def test_a_turtle_turns_first_and_goes_in_the_new_direction(turtle, canvas):
    turtle.command(1.0, 0.0, 50.0, now=0.0)  # 0.8 rad in a tick
    turtle.step(0.0, canvas)
    assert turtle.theta == pytest.approx(0.8)
    assert turtle.place == pytest.approx((5 + TICK * math.cos(0.8), 5 + TICK * math.sin(0.8)))


def test_linear_y_goes_to_the_left(turtle, canvas):
    turtle.theta = math.pi / 2
    turtle.command(0.0, 2.0, 0.0, now=0.0)
    turtle.step(0.0, canvas)
    assert turtle.place == pytest.approx((5 - 2 * TICK, 5.0))


@pytest.mark.parametrize("theta, wrapped", [
    (math.pi, -math.pi), (-math.pi, -math.pi), (3.2, 3.2 - 2 * math.pi), (-7.0, 2 * math.pi - 7),
    (0.5 + 40 * math.pi, 0.5),
])
def test_theta_is_kept_from_minus_pi_to_pi(turtle, canvas, theta, wrapped):
    turtle.theta = theta
    turtle.step(0.0, canvas)
    assert turtle.theta == pytest.approx(wrapped)


def test_speed_is_a_magnitude(turtle):
    turtle.command(-3.0, 4.0, -1.0, now=0.0)
    assert (turtle.speed, turtle.turn_rate) == (5.0, -1.0)


def test_a_command_lives_for_one_second(turtle, canvas):
    turtle.command(1.0, 0.0, 1.0, now=10.0)
    turtle.step(11.0, canvas)
    assert (turtle.speed, turtle.turn_rate) == (1.0, 1.0)
    place = turtle.place
    turtle.step(11.001, canvas)
    assert (turtle.speed, turtle.turn_rate, turtle.place) == (0.0, 0.0, place)


def test_the_last_command_counts_and_lives_anew(turtle, canvas):
    turtle.command(1.0, 0.0, 0.0, now=0.0)
    turtle.command(0.5, 0.0, 0.0, now=0.9)
    turtle.step(1.5, canvas)
    assert turtle.speed == 0.5


@pytest.mark.parametrize("theta, x, y", [
    (0.0, SIDE, 5.0), (math.pi, 0.0, 5.0), (math.pi / 2, 5.0, SIDE), (-math.pi / 2, 5.0, 0.0),
])
def test_the_wall_holds_the_turtle_but_not_its_speed(turtle, canvas, theta, x, y):
    turtle.theta = theta
    turtle.command(1000.0, 0.0, 0.0, now=0.0)
    for _ in range(3):
        assert turtle.step(0.5, canvas) is not None
        assert turtle.place == pytest.approx((x, y))
    assert turtle.speed == 1000.0


def test_the_wall_says_where_the_turtle_wanted_to_be(turtle, canvas):
    turtle.command(1000.0, 0.0, 0.0, now=0.0)
    assert turtle.step(0.0, canvas) == pytest.approx((21.0, 5.0))
    turtle.command(-1.0, 0.0, 0.0, now=0.0)
    assert turtle.step(0.0, canvas) is None


def test_the_first_pen_is_light_and_three_pixels_wide(turtle, canvas):
    turtle.command(1 / TICK, 0.0, 0.0, now=0.0)  # 45 pixels
    turtle.step(0.0, canvas)
    pixels = drawn(canvas)
    assert set(pixels.values()) == {PEN}
    assert {row for row, _ in pixels} == {273, 274, 275}  # 499 - 45 * 5 and its neighbours
    columns = {column for row, column in pixels if row == 274}
    assert set(range(225, 271)) <= columns <= set(range(222, 274))


def test_a_pen_that_is_off_draws_nothing_and_keeps_its_colour(turtle, canvas):
    turtle.set_pen((9, 9, 9), 7, off=True)
    turtle.command(60.0, 0.0, 0.0, now=0.0)
    turtle.step(0.0, canvas)
    assert not drawn(canvas)
    assert (turtle.pen.color, turtle.pen.width_px) == (PEN, 3)


def test_pen_colour_and_width(turtle, canvas):
    turtle.set_pen(RED, 9, off=False)
    turtle.command(1 / TICK, 0.0, 0.0, now=0.0)
    turtle.step(0.0, canvas)
    assert set(drawn(canvas).values()) == {RED}
    assert len({row for row, column in drawn(canvas) if column == 248}) == 9


def test_width_0_is_one_pixel(turtle, canvas):
    turtle.set_pen(RED, 0, off=False)
    turtle.command(1 / TICK, 0.0, 0.0, now=0.0)
    turtle.step(0.0, canvas)
    assert len({row for row, _ in drawn(canvas)}) == 1


def test_teleport_relative_turns_and_then_moves(turtle, canvas):
    turtle.teleport_relative(2.0, math.pi / 2)
    turtle.step(0.0, canvas)
    assert (*turtle.place, turtle.theta) == pytest.approx((5.0, 7.0, math.pi / 2))
    assert drawn(canvas)


def test_teleport_absolute_draws_a_line_there(turtle, canvas):
    turtle.teleport_absolute(5.0, 8.0, 1.0)
    turtle.step(0.0, canvas)
    assert (*turtle.place, turtle.theta) == (5.0, 8.0, 1.0)
    assert {row for row, column in drawn(canvas) if column == 225} >= set(range(139, 275))


def test_teleport_above_the_top_is_no_wall(turtle, canvas):
    turtle.teleport_absolute(5.0, 30.0, 0.0)
    assert turtle.step(0.0, canvas) is None
    assert turtle.place == pytest.approx((5.0, SIDE))


def test_teleport_beside_the_pond_hits_the_wall(turtle, canvas):
    turtle.teleport_absolute(1e30, 5.0, 0.0)
    assert turtle.step(0.0, canvas) == (1e30, 5.0)
    assert turtle.place == (SIDE, 5.0)
    assert {column for row, column in drawn(canvas) if row == 274} >= set(range(226, 500))


def test_teleports_wait_for_the_step_and_go_in_order(turtle, canvas):
    turtle.teleport_absolute(1.0, 1.0, 0.0)
    turtle.teleport_relative(1.0, 0.0)
    assert turtle.place == (5.0, 5.0)
    turtle.step(0.0, canvas)
    assert turtle.place == pytest.approx((2.0, 1.0))


def test_the_colour_sensor_sees_the_surface_not_the_own_new_line(turtle, canvas):
    turtle.command(10.0, 0.0, 0.0, now=0.0)
    turtle.step(0.0, canvas)
    assert turtle.color == BACKGROUND
    turtle.command(0.0, 0.0, 0.0, now=0.0)
    turtle.step(0.0, canvas)
    assert turtle.color == PEN


def test_any_speed_ends_at_the_wall(turtle, canvas):
    turtle.command(1e308, -1e308, 1e308, now=0.0)
    turtle.step(0.0, canvas)
    assert 0 <= turtle.x <= SIDE and 0 <= turtle.y <= SIDE and -math.pi <= turtle.theta < math.pi
