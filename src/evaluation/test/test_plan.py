"""A plan's grid: each number is wholly in the picture, also at its edges."""

import numpy as np

from evaluation.picture import FAINT, FLOOR, NUMERAL_PX, Plan, bgr, text_width, write_text

PX_PER_M = 100


def drawn(low, high):
    """A plan of this area with a grid of 1 m."""
    plan = Plan(low, high, round((high[0] - low[0]) * PX_PER_M))
    plan.grid(1.0)
    return plan


def ink_of(text):
    """How much of a text there is, wherever it stands."""
    blank = np.full((40, 40, 3), bgr(FLOOR), np.uint8)
    write_text(blank, text, (5, 25), NUMERAL_PX, bgr(FAINT))
    return bright(blank)


def bright(picture):
    """How many pixels are brighter than a grid's line."""
    return int((picture.max(axis=2) > 60).sum())


def test_the_uppermost_number_is_below_its_line():
    plan = drawn((0.5, 0.5), (3.5, 2.05))  # the line at 2 m is 5 px from the top
    corner = plan.image[:5 + 4 + NUMERAL_PX + 3, :4 + text_width("2", NUMERAL_PX) + 3]
    assert bright(corner) == ink_of("2")


def test_the_rightmost_number_is_left_of_its_line():
    plan = drawn((0.5, 0.5), (3.05, 2.5))  # the line at 3 m is 5 px from the right
    wide = 5 + 4 + text_width("3", NUMERAL_PX) + 3
    assert bright(plan.image[-4 - NUMERAL_PX - 3:, -wide:]) == ink_of("3")


def test_other_numbers_stand_right_of_and_above_their_lines():
    plan = drawn((0.5, 0.5), (3.5, 2.5))
    assert bright(plan.image[50 - 4 - NUMERAL_PX - 3:50, :20]) == ink_of("2")
