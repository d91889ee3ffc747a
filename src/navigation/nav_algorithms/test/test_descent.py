"""Down a potential to its source, and how far a front goes, with answers worked out by hand."""

import numpy as np
import pytest

from nav_algorithms.global_planning.descent import descend
from nav_algorithms.global_planning.heap import pop, push
from nav_algorithms.global_planning.potential import spread, spread_everywhere

SIZE = 10


def distances(column, row):
    """To a cell of 10 x 10 as the crow flies; what lies behind the array in memory is no part."""
    beside = 99.0 * np.abs(np.arange(SIZE) - 7.0)
    around = np.tile(beside, (3 * SIZE, 1))
    found = around[SIZE:2 * SIZE]
    rows, columns = np.indices(found.shape)
    found[:] = np.hypot(rows - row, columns - column)
    return found


@pytest.mark.parametrize("source, start", [
    ((5, 5), (9.2, 5.0)), ((5, 5), (0.8, 5.0)), ((5, 5), (5.0, 9.2)), ((5, 5), (5.0, 0.8)),
    ((4, 0), (4.0, 9.3)), ((4, 9), (4.0, -0.3)), ((0, 4), (9.3, 4.0)), ((9, 4), (-0.3, 4.0))])
def test_along_a_row_or_a_column_the_way_is_straight(source, start):
    points = descend(distances(*source), *start, True)
    assert points[0].tolist() == list(start) and points[-1].tolist() == list(source)
    axis = 0 if start[0] == source[0] else 1
    assert points[:, axis] == pytest.approx(np.full(len(points), source[axis]))
    assert len(points) <= 2 * SIZE + 2


@pytest.mark.parametrize("along", [0, 1])
@pytest.mark.parametrize("beside", [0.4, 8.6])
@pytest.mark.parametrize("way, begin", [(-0.5, 8.0), (0.5, 1.0)])
def test_between_the_outermost_cells_the_way_is_smooth_too(along, beside, way, begin):
    """Half a cell a step down an even slope, and not from centre to centre."""
    slope = np.tile(np.arange(float(SIZE))[::-1 if way > 0.0 else 1], (SIZE, 1))
    start = [beside, beside]
    start[along] = begin
    points = descend(np.ascontiguousarray(slope if along == 0 else slope.T), *start, True)
    assert points[:-1, 1 - along] == pytest.approx(np.full(len(points) - 1, beside))
    assert np.diff(points[:-1, along]) == pytest.approx(np.full(len(points) - 2, way))


@pytest.mark.parametrize("source, start", [((0, 0), (0, 9)), ((0, 0), (9, 0)), ((9, 9), (0, 9)),
                                           ((9, 9), (9, 0))])
def test_from_cell_to_cell_the_edge_of_the_map_is_followed(source, start):
    points = descend(distances(*source), *map(float, start), False)
    ends = np.array([start, source])
    expected = np.linspace(*ends, SIZE)
    assert points.tolist() == [*expected.tolist(), list(source)]


@pytest.mark.parametrize("row", [0, 6])
@pytest.mark.parametrize("column", [0, 8])
def test_from_a_corner_streets_are_as_long_as_their_blocks(row, column):
    cost, source = np.ones((7, 9)), np.array([[row, column]])
    streets = spread(cost, source, np.zeros(1), -1, -1, False, 0.0, 0.0)
    rows, columns = np.indices(cost.shape)
    assert (streets == np.abs(rows - row) + np.abs(columns - column)).all()


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_heap_gives_the_least_key_first_and_of_equal_ones_the_first_item(seed):
    given = np.random.default_rng(seed).integers(0, 8, 40)  # many are equal
    keys, items = np.full(40, -1.0), np.full(40, -1)
    for count, key in enumerate(given):
        assert push(keys, items, count, float(key), count) == count + 1
    found = []
    for count in range(40, 0, -1):
        found.append((int(keys[0]), int(items[0])))
        assert pop(keys, items, count) == count - 1
    assert found == sorted((int(key), item) for item, key in enumerate(given))


def test_a_star_goes_straight_to_its_target():
    cost, middle = np.ones((21, 41)), np.array([[10, 5]])
    found = spread(cost, middle, np.zeros(1), 10, 35, False, 1.0, 0.0)
    assert found[10, 35] == 30.0
    rows = np.flatnonzero(np.isfinite(found).any(axis=1))
    assert rows.tolist() == [9, 10, 11]  # its own, and what lies beside it
    assert np.isfinite(spread(cost, middle, np.zeros(1), 10, 35, False, 0.0, 0.0)).sum() > 600


@pytest.mark.parametrize("row, column", [(-1, 3), (3, -1), (10**9, 3), (3, 10**12)])
def test_to_a_target_outside_the_front_goes_everywhere(row, column):
    cost, source = np.ones((7, 9)), np.array([[3, 4]])
    found = spread(cost, source, np.zeros(1), row, column, True, 0.0, 0.0)
    assert (found == spread_everywhere(cost, source, np.zeros(1))).all()
    assert np.isfinite(found).all()
