"""Recovery behaviours, one command at a time."""

import numpy as np
import pytest
from defaults import of

from nav_algorithms import recovery
from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.recovery import EscapeSettings, RotateSettings

WAFFLE = np.array([[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]])
ORIGIN = np.zeros(3)


def rotation(*arguments, **settings):
    return recovery.rotation(*arguments, of(RotateSettings, **settings))


def escape(*arguments, **settings):
    return recovery.escape(*arguments, of(EscapeSettings, **settings))


def free():
    return Costmap(np.zeros((60, 60), np.uint8), 0.05, (-1.5, -1.5))


def test_a_turn_goes_once_round_and_slows_down():
    assert rotation(free(), WAFFLE, ORIGIN, 0.0).velocity.tolist() == [0, 0, 1.0]
    near = rotation(free(), WAFFLE, ORIGIN, 2 * np.pi - 0.11, acc_lim_theta=1.0)
    assert near.omega == pytest.approx(np.sqrt(0.22))
    assert rotation(free(), WAFFLE, ORIGIN, 2 * np.pi - 0.101,
                    acc_lim_theta=0.1).omega == 0.4
    assert rotation(free(), WAFFLE, ORIGIN, 2 * np.pi - 0.05).omega == 0.0


def test_a_turn_that_would_touch_is_none():
    costmap = free()
    costmap.cells[tuple(costmap.cells_of((0.15, 0.0)))] = LETHAL
    assert footprints.costs(costmap, WAFFLE, ORIGIN)[0] == 0
    assert rotation(costmap, WAFFLE, ORIGIN, 0.0) is None
    assert rotation(costmap, WAFFLE, ORIGIN, 6.1) is not None


def test_the_way_out_of_a_dead_end_is_backwards():
    costmap = free()
    costmap.cells[:, 33:] = LETHAL
    costmap.cells[:26] = costmap.cells[34:] = LETHAL
    command = escape(costmap, WAFFLE, ORIGIN)
    assert (command.vx, command.omega) == (-0.1, 0.0)
    assert command.trajectory[-1] == pytest.approx([-0.4, 0, 0])
    assert (footprints.costs(costmap, WAFFLE, command.trajectory) >= 0).all()


def test_the_way_out_is_forwards_where_a_wall_is_behind():
    costmap = free()
    costmap.cells[:, :25] = LETHAL
    assert escape(costmap, WAFFLE, ORIGIN).vx == 0.1


def test_with_as_much_room_at_either_end_the_way_is_back():
    costmap = free()
    costmap.cells[:, :18] = costmap.cells[:, 43:] = LETHAL  # 5 cells from either end
    assert escape(costmap, WAFFLE, np.array([0.02, 0, 0])).vx == -0.1


def test_a_thin_wall_on_the_way_is_not_driven_over():
    costmap = free()
    costmap.cells[:, 33:] = LETHAL
    costmap.cells[:, 24] = LETHAL  # behind the robot, and before it 0.4 m farther back
    assert escape(costmap, WAFFLE, ORIGIN) is None


@pytest.mark.parametrize("side, wall", [(1.0, slice(None, 26)), (-1.0, slice(-26, None))])
def test_a_car_leaves_in_a_curve_away_from_the_wall(side, wall):
    costmap = free()
    costmap.cells[wall] = LETHAL
    command = escape(costmap, WAFFLE, ORIGIN, minimum_turning_radius=0.4)
    assert command.omega == pytest.approx(-side * 0.1 / 0.4)  # backwards
    assert command.trajectory[-1, 1] == pytest.approx(side * 0.4 * (1.0 - np.cos(1.0)))


def test_half_the_way_is_better_than_none():
    costmap = free()
    costmap.cells[:, 33:] = LETHAL
    costmap.cells[:, :20] = LETHAL
    command = escape(costmap, WAFFLE, ORIGIN)
    assert command.trajectory[-1, 0] == pytest.approx(-0.2)
    costmap.cells[:, :25] = LETHAL
    assert escape(costmap, WAFFLE, ORIGIN) is None
