"""Layers and what they make together, with answers worked out by hand."""

import numpy as np
import pytest

from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.inflation import InflationLayer, cost_table
from nav_algorithms.costmap.layer import Bounds, Layer, combine, shifted
from nav_algorithms.costmap.layered import LayeredCostmap
from nav_algorithms.costmap.static import StaticLayer, costs_of

HERE = np.zeros(3)
SQUARE = np.array([[0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.2, -0.2]])


def grid(shape, **occupied):
    cells = np.zeros(shape, np.int8)
    for value, places in occupied.items():
        for place in places:
            cells[place] = {"wall": 100, "unknown": -1, "half": 50}[value]
    return OccupancyGrid(cells, 0.1, (0.0, 0.0))


def with_map(found, *layers, **settings):
    static = StaticLayer("static", rolling=settings.get("rolling", False))
    layered = LayeredCostmap([static, *layers], found.cells.shape, found.resolution, found.origin,
                             **settings)
    static.set_map(found, costs_of(found.cells))
    return layered, static


class Painter(Layer):
    """A layer that writes one cost wherever it says so."""

    def __init__(self, cost, points=()):
        super().__init__("painter")
        self.cost, self.points = cost, points

    def update_bounds(self, pose, bounds):
        bounds.add(np.reshape(self.points, (-1, 2)))

    def update_costs(self, master, window):
        master.cells[window] = np.maximum(master.cells[window], self.cost)


def test_bounds_become_the_cells_that_they_touch():
    costmap = Costmap(np.zeros((10, 20), np.uint8), 0.5, (1.0, 2.0))
    bounds = Bounds()
    assert bounds.window(costmap) is None
    bounds.add([[2.1, 3.6], [3.4, 2.2]])
    assert bounds.window(costmap) == (slice(0, 4), slice(2, 5))
    bounds.widen(0.5)
    assert bounds.window(costmap) == (slice(0, 5), slice(1, 6))
    far = Bounds()
    far.add([-5.0, 3.0])
    assert far.window(costmap) is None
    far.add_all()
    assert far.window(costmap) == (slice(0, 10), slice(0, 20))


@pytest.mark.parametrize("method, expected", [
    (1, [[LETHAL, 20, 30, 5]]), (0, [[10, 20, 30, 5]]),  # maximum and overwrite, as upstream
    (99, [[LETHAL, 20, UNKNOWN, 0]])])
def test_ways_to_combine(method, expected):
    master = np.array([[LETHAL, 20, UNKNOWN, 0]], np.uint8)
    combine(master, np.array([[10, UNKNOWN, 30, 5]], np.uint8), method)
    assert master.tolist() == expected


@pytest.mark.parametrize("rows, columns, expected", [
    (0, 0, [[1, 2], [3, 4]]), (1, 0, [[3, 4], [9, 9]]), (-1, 0, [[9, 9], [1, 2]]),
    (0, 1, [[2, 9], [4, 9]]), (1, -1, [[9, 3], [9, 9]]), (2, 0, [[9, 9], [9, 9]])])
def test_shifting(rows, columns, expected):
    assert shifted(np.array([[1, 2], [3, 4]], np.uint8), rows, columns, 9).tolist() == expected


@pytest.mark.parametrize("settings, expected", [
    ({}, [UNKNOWN, FREE, FREE, LETHAL]),
    ({"track_unknown": False}, [FREE, FREE, FREE, LETHAL]),
    ({"lethal_threshold": 150}, [UNKNOWN, FREE, FREE, LETHAL]),
    ({"lethal_threshold": 50}, [UNKNOWN, FREE, LETHAL, LETHAL]),
    ({"trinary": False}, [UNKNOWN, FREE, 127, LETHAL]),
    ({"unknown_value": 50}, [LETHAL, FREE, UNKNOWN, LETHAL])])
def test_what_a_maps_values_cost(settings, expected):
    assert costs_of(np.array([-1, 0, 50, 100], np.int8), **settings).tolist() == expected


def test_only_what_was_touched_is_written_again():
    painter = Painter(7, [0.55, 0.35])
    layered = LayeredCostmap([painter], (10, 10), 0.1, (0.0, 0.0))
    assert layered.update(HERE) == (slice(0, 10), slice(0, 10))
    painter.cost = 9
    assert layered.update(HERE) == (slice(3, 4), slice(5, 6))
    assert layered.master.cells[3, 5] == 9 and (layered.master.cells == 7).sum() == 99
    painter.points = ()
    assert layered.update(HERE) is None


@pytest.mark.parametrize("track, default", [(True, UNKNOWN), (False, FREE)])
def test_what_nobody_knows(track, default):
    layered = LayeredCostmap([], (4, 4), 0.1, (0.0, 0.0), track_unknown=track)
    layered.update(HERE)
    assert (layered.master.cells == default).all()


def test_a_map_is_copied_and_so_are_its_changes():
    layered, static = with_map(grid((5, 6), wall=[(1, 2)], unknown=[(0, 0)]))
    layered.update(HERE)
    assert layered.master.cells[1, 2] == LETHAL and layered.master.cells[0, 0] == UNKNOWN
    assert layered.update(HERE) is None
    static.change_map(3, 4, np.array([[LETHAL, FREE]], np.uint8))
    assert layered.update(HERE) == (slice(3, 4), slice(4, 6))
    assert layered.master.cells[3, 4] == LETHAL
    static.change_map(0, 1, np.full((2, 3), LETHAL, np.uint8))
    assert layered.update(HERE) == (slice(0, 2), slice(1, 4))
    assert (layered.master.cells[:3, :4] == LETHAL).sum() == 6
    with pytest.raises(ValueError, match="outside the map"):
        static.change_map(3, 5, np.zeros((1, 2), np.uint8))
    with pytest.raises(ValueError, match="outside the map"):
        static.change_map(4, 0, np.zeros((2, 1), np.uint8))


def test_a_map_in_another_frame_is_turned_into_a_rolling_window():
    layered, static = with_map(grid((40, 40), wall=[(10, 30)]), rolling=True)
    static.frame_in_map = np.array([2.0, 2.0, np.pi / 2])  # the wall is at (-1, -1) of it
    layered.update(HERE)
    found = layered.master.centres_of(np.argwhere(layered.master.cells == LETHAL))
    assert found == pytest.approx(np.array([[-0.95, -1.05]]), abs=0.1)
    static.frame_in_map = None
    layered.update(HERE)
    assert not layered.master.cells.any()


def test_a_rolling_window_keeps_the_robot_in_its_middle():
    layered = LayeredCostmap([], (20, 40), 0.1, (0.0, 0.0), rolling=True)
    layered.update(np.array([10.03, -5.07, 0.0]))
    assert layered.master.origin == pytest.approx((8.0, -6.1))
    assert layered.update(np.array([10.04, -5.01, 1.0])) is None
    assert layered.update(np.array([9.99, -5.01, 1.0])) is not None
    assert layered.master.origin == pytest.approx((7.9, -6.1))


def test_the_law_of_inflation():
    table = cost_table(0.1, 0.2, 0.45, 10.0)
    assert len(table) == 5 ** 2 + 2  # 0.45 m is five cells
    assert table[0] == LETHAL and table[1] == table[4] == INSCRIBED
    assert table[5] == int(252 * np.exp(-10 * (np.sqrt(5) * 0.1 - 0.2)))
    assert table[25] == int(252 * np.exp(-3.0)) and table[26] == FREE


@pytest.mark.parametrize("outline, inscribed", [(SQUARE, 0.2), (SQUARE[:2], 0.0), (None, 0.0)])
def test_costs_about_a_wall_are_those_of_the_exact_distance(outline, inscribed):
    inflation = InflationLayer("inflation", inflation_radius=0.5, cost_scaling_factor=3.0)
    walls = [(5, 5), (30, 12), (31, 12), (20, 39)]
    layered, _ = with_map(grid((40, 40), wall=walls), inflation)
    if outline is not None:
        layered.set_footprint(outline)
    layered.update(HERE)
    rows, columns = np.indices((40, 40))
    squares = np.min([(rows - r) ** 2 + (columns - c) ** 2 for r, c in walls], axis=0)
    expected = cost_table(0.1, inscribed, 0.5, 3.0)[np.minimum(squares, 26)]
    assert (layered.master.cells == expected).all()


@pytest.mark.parametrize("rolling, unknown", [(False, [LETHAL, 100]), (True, [UNKNOWN, UNKNOWN])])
def test_a_map_over_other_layers_with_use_maximum(rolling, unknown):
    """An obstacle stays one where the map knows nothing; not in a rolling window, as upstream."""
    static = StaticLayer("static", rolling, use_maximum=True)
    found = grid((1, 4), wall=[(0, 0)], unknown=[(0, 2), (0, 3)])
    below = Painter(0, [(0.0, 0.0), (0.39, 0.09)])
    below.update_costs = lambda master, window: np.copyto(
        master.cells, np.array([[7, 100, LETHAL, 100]], np.uint8))
    layered = LayeredCostmap([below, static], (1, 4), 0.1, (0.0, 0.0), rolling)
    static.set_map(found, costs_of(found.cells))
    layered.update(np.array([0.2, 0.05, 0.0]))
    assert layered.master.cells.tolist() == [[LETHAL, 100, *unknown]]


def test_what_was_written_counts_until_a_new_size_is_written():
    """Else a plan that is made just then would lead through the walls of a map that has grown."""
    layered, static = with_map(grid((3, 3), wall=[(1, 1)]))
    layered.update(HERE)
    assert layered.fits((3, 3), 0.1, np.zeros(2)) and not layered.fits((3, 3), 0.1, (0.0, 0.1))
    assert not layered.fits((3, 3), 0.2, np.zeros(2)) and not layered.fits((3, 4), 0.1, np.zeros(2))
    layered.resize((5, 5), 0.1, (0.0, 0.0))
    assert layered.newest.cells.tolist() == [[0, 0, 0], [0, LETHAL, 0], [0, 0, 0]]
    larger = grid((5, 5), wall=[(2, 2)])
    static.set_map(larger, costs_of(larger.cells))
    layered.update(HERE)
    assert layered.newest is layered.master and layered.newest.cells[2, 2] == LETHAL


@pytest.mark.parametrize("inflate_unknown", [(), (False,), (True,)])
@pytest.mark.parametrize("scaling, cost", [(3.0, int(252 * np.exp(-0.3))), (51.0, 1)])
def test_inflation_of_unknown_cells(inflate_unknown, scaling, cost):
    inflation = InflationLayer("inflation", 0.5, scaling, *inflate_unknown)
    unknown = [(5, 2), (5, 4)]  # at 0.3 m and at 0.1 m
    layered, _ = with_map(grid((10, 10), wall=[(5, 5)], unknown=unknown), inflation,
                          track_unknown=True)
    layered.set_footprint(SQUARE)
    layered.update(HERE)
    assert layered.master.cells[5, 4] == INSCRIBED
    assert layered.master.cells[5, 2] == (cost if any(inflate_unknown) else UNKNOWN)


def test_inflated_costs_go_when_their_obstacle_goes():
    inflation = InflationLayer("inflation", 0.4, 3.0)
    layered, static = with_map(grid((40, 40), wall=[(20, 20)]), inflation)
    layered.set_footprint(SQUARE)
    layered.update(HERE)
    static.change_map(20, 20, np.zeros((1, 1), np.uint8))
    assert layered.update(HERE) == (slice(16, 25), slice(16, 25))
    assert not layered.master.cells.any()
    inflation.reset()
    assert layered.update(HERE) == (slice(0, 40), slice(0, 40))


@pytest.mark.parametrize("radius", [0.1, 0.35])
def test_partial_updates_equal_whole_ones(radius):
    inflation = InflationLayer("inflation", radius, 3.0)
    layered, static = with_map(grid((30, 30), wall=[(3, 3)]), inflation)
    layered.set_footprint(SQUARE)
    generator = np.random.default_rng(2)
    for _ in range(40):
        row, column = generator.integers(0, 29, 2).tolist()
        cost = generator.choice([FREE, LETHAL])
        static.change_map(row, column, np.full((2, 2), cost, np.uint8))
        layered.update(HERE)
        partial = layered.master.cells.copy()
        layered.write_all()
        layered.update(HERE)
        assert (layered.master.cells == partial).all()


def test_a_layer_that_is_off_does_nothing():
    inflation = InflationLayer("inflation")
    layered, static = with_map(grid((10, 10), wall=[(5, 5)]), inflation)
    layered.set_footprint(SQUARE)
    inflation.change(0.3, 3.0, False, enabled=False)
    layered.update(HERE)
    assert (layered.master.cells > 0).sum() == 1
    static.enabled = False
    layered.write_all()
    layered.update(HERE)
    assert not layered.master.cells.any()
