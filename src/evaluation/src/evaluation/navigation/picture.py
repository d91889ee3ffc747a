"""map.png: the map that was built, the true walls, the ways that were driven, the goals."""

from __future__ import annotations

import numpy as np

from evaluation.colours import CAR, FLOOR, TEXT, lap_colour
from evaluation.navigation.score import Result
from evaluation.picture import legend, map_sheet, pixels
from nav_algorithms.grid import FREE, OCCUPIED, OccupancyGrid
from nav_algorithms.poses import transform_points
from trial_worlds.ground import Ground

CLEAR, TRUE_WALL, GOAL = "#363a42", "#3cbe78", "#fac846"
OCCUPIED_FROM = 50  # percent
PATHS = (("mapping", "driven while mapping", lap_colour(0)),
         ("goals", "driven to the goals", lap_colour(3)))


def map_picture(ground: Ground, result: Result, title: str, subtitle: str) -> np.ndarray:
    """The picture (rows, 1400, 3), BGR."""
    walls = ground.walls
    low = np.array(walls.origin)
    high = low + np.array(walls.cells.shape[::-1]) * walls.resolution
    figure, axes = map_sheet(title, subtitle, low - 0.3, high + 0.3)
    axes.grid(False)
    if result.map is not None:
        _draw_cells(axes, result.map, result.map_in_world)
    x, y = _edges(walls)
    middle = walls.resolution / 2
    axes.contour(x[:-1] + middle, y[:-1] + middle, walls.cells == OCCUPIED, levels=[0.5],
                 colors=[TRUE_WALL], linewidths=1)
    axes.plot([], [], color=TRUE_WALL, label="true wall")
    for part, text, colour in PATHS:
        axes.plot(*result.paths.get(part, np.empty((0, 2))).T, color=colour, linewidth=2,
                  label=text)
    ways = result.navigation.ways if result.navigation else []
    for number, way in enumerate(ways, start=1):
        ends = transform_points(np.array(way.goal), np.array([(0.0, 0.0), (0.4, 0.0)]))
        axes.plot(*ends.T, color=GOAL if way.reached else CAR, linewidth=2, marker="o",
                  markevery=[0], markersize=12, fillstyle="none")
        axes.annotate(str(number), ends[0], (10, 8), textcoords="offset points", color=TEXT)
    for colour, text in ((GOAL, "goal"), (CAR, "not reached")):
        axes.plot([], [], "o", color=colour, fillstyle="none", label=text)
    legend(axes)
    return pixels(figure)


def _draw_cells(axes: object, grid: OccupancyGrid, grid_in_world: np.ndarray) -> None:
    """Free and occupied cells, turned to where the map lies in the world."""
    from matplotlib.colors import ListedColormap

    shade = np.zeros(grid.cells.shape)
    shade[(grid.cells >= FREE) & (grid.cells < OCCUPIED_FROM)] = 1
    shade[grid.cells >= OCCUPIED_FROM] = 2
    corners = np.stack(np.meshgrid(*_edges(grid)), axis=-1)
    there = transform_points(np.asarray(grid_in_world), corners.reshape(-1, 2))
    axes.pcolormesh(*there.reshape(corners.shape).transpose(2, 0, 1), shade, vmin=0, vmax=2,
                    cmap=ListedColormap([FLOOR, CLEAR, TEXT]), rasterized=True)


def _edges(grid: OccupancyGrid) -> tuple[np.ndarray, np.ndarray]:
    """x and y of the cells' borders in the grid's frame, m."""
    rows, columns = grid.cells.shape
    return (grid.origin[0] + np.arange(columns + 1) * grid.resolution,
            grid.origin[1] + np.arange(rows + 1) * grid.resolution)
