"""The pond's turtles and its picture against upstream's rules; needs no master."""

import random

import numpy as np
import pytest
from turtlesim.pond.canvas import LOOKS, SIDE, draw_turtle
from turtlesim.pond.pond import BACKGROUND, Pond, PondError

GREY = (90, 90, 90)


@pytest.fixture
def pond():
    return Pond(random.Random(1))


def names(pond):
    return sorted(pond.turtles)


def test_turtle1_begins_in_the_middle_heading_right(pond):
    turtle = pond.turtles["turtle1"]
    assert names(pond) == ["turtle1"]
    assert (turtle.x, turtle.y, turtle.theta) == pytest.approx((5.544445, 5.544445, 0), abs=1e-6)


def test_a_turtle_without_a_name_gets_the_next_number(pond):
    assert [pond.spawn("", 1, 2, 3) for _ in range(2)] == ["turtle2", "turtle3"]
    assert (pond.turtles["turtle3"].x, pond.turtles["turtle3"].theta) == (1, 3)


def test_numbers_that_are_taken_are_left_out_and_none_comes_again(pond):
    pond.spawn("turtle2", 1, 1, 0)
    assert pond.spawn("", 1, 1, 0) == "turtle3"
    pond.kill("turtle3")
    assert pond.spawn("", 1, 1, 0) == "turtle4"


def test_a_name_is_given_once(pond):
    assert pond.spawn("leo", 1, 1, 0) == "leo"
    with pytest.raises(PondError, match=r"A turtle named \[leo\] already exists"):
        pond.spawn("leo", 2, 2, 0)
    assert pond.turtles["leo"].x == 1


def test_a_killed_turtle_is_gone_and_its_lines_stay(pond):
    pond.turtles["turtle1"].command(60.0, 0.0, 0.0, now=0.0)
    pond.step(0.0)
    before = pond.canvas.pixels.copy()
    pond.kill("turtle1")
    assert names(pond) == []
    assert np.array_equal(pond.picture(), before)
    assert (before != BACKGROUND).any()


def test_killing_an_unknown_turtle_is_an_error(pond):
    with pytest.raises(PondError, match=r"kill turtle \[leo\], which does not exist"):
        pond.kill("leo")


def test_clear_takes_the_lines_away_and_leaves_the_turtles(pond):
    pond.turtles["turtle1"].command(60.0, 0.0, 0.0, now=0.0)
    pond.step(0.0)
    place = pond.turtles["turtle1"].place
    pond.clear(GREY)
    assert (pond.canvas.pixels == GREY).all()
    assert pond.turtles["turtle1"].place == place


def test_reset_is_the_beginning(pond):
    pond.spawn("", 1, 1, 0)
    pond.spawn("leo", 1, 1, 0)
    pond.turtles["turtle1"].set_pen((1, 2, 3), 9, off=False)
    pond.turtles["turtle1"].command(60.0, 0.0, 1.0, now=0.0)
    pond.step(0.0)
    pond.reset(GREY)
    turtle = pond.turtles["turtle1"]
    assert names(pond) == ["turtle1"]
    assert (turtle.x, turtle.theta, turtle.speed) == (SIDE / 2, 0.0, 0.0)
    assert (turtle.pen.color, turtle.pen.width_px) == ((179, 184, 255), 3)
    assert (pond.canvas.pixels == GREY).all()
    assert pond.spawn("", 1, 1, 0) == "turtle2"


def test_wall_hits_of_all_turtles_come_back(pond):
    pond.spawn("a", 20, 1, 0)
    pond.spawn("b", 1, -3, 0)
    assert pond.step(0.0) == [(20, 1), (1, -3)]
    assert pond.step(0.0) == []


def test_the_picture_is_the_surface_with_the_turtles_on_it(pond):
    picture = pond.picture()
    assert (picture.shape, picture.dtype) == ((500, 500, 3), np.uint8)
    changed = np.argwhere((picture != BACKGROUND).any(axis=2))
    assert (pond.canvas.pixels == BACKGROUND).all()
    assert np.ptp(changed, axis=0) == pytest.approx((39, 45), abs=4)  # 45 pixels: upstream's metre
    assert (changed.min(axis=0) + changed.max(axis=0)) / 2 == pytest.approx((249.5, 249.5), abs=2)


def test_a_picture_stays_the_same_until_something_changes(pond):
    first = pond.picture()
    pond.step(0.0)
    assert pond.picture() is first
    pond.turtles["turtle1"].command(0.0, 0.0, 1.0, now=0.0)
    pond.step(0.0)
    assert (pond.picture() != first).any()


@pytest.mark.parametrize("look", range(len(LOOKS)))
@pytest.mark.parametrize("theta, row, column", [(0, 0, 1), (np.pi / 2, -1, 0), (np.pi, 0, -1)])
def test_a_turtle_is_drawn_with_its_head_where_it_heads(look, theta, row, column):
    picture = np.full((500, 500, 3), 255, np.uint8)
    draw_turtle(picture, (5.0, 5.0), theta, look)

    def darkest(side):
        """Of a small patch 20 pixels out: eyes are the only dark thing there."""
        y, x = 274 + side * row * 20, 225 + side * column * 20
        return picture[y - 4 : y + 5, x - 4 : x + 5].max(axis=2).min()

    assert darkest(1) < darkest(-1) - 40


@pytest.mark.parametrize("place, seen", [
    ((0, 0), True), ((SIDE, SIDE), True), ((-0.3, 5), True), ((5, 11.5), True),
    ((-1.5, 5), False), ((-40, 5), False), ((5, 1e6), False), ((5, -1e6), False),
])
def test_a_turtle_at_or_beyond_the_edge_can_be_drawn(place, seen):
    picture = np.full((500, 500, 3), 255, np.uint8)
    draw_turtle(picture, place, 1.0, 0)
    assert (picture != 255).any() == seen


def test_looks_are_drawn_from_the_generator():
    def looks(seed):
        pond = Pond(random.Random(seed))
        return [pond.turtles[pond.spawn("", 1, 1, 0)].look for _ in range(20)]

    assert looks(5) == looks(5)
    assert len(set(looks(5))) > 3
