"""map.png: the map that was built, the true walls, the ways that were driven, the goals."""

from __future__ import annotations

import cv2
import numpy as np

from evaluation.house.ground import Ground
from evaluation.house.house_map import CLEAR, GOAL, MISSED, TRUE_WALL, WALL, HouseMap
from evaluation.navigation.score import Result
from evaluation.picture import FAINT, LAP_COLOURS, PAPER, draw_line, write_text

WIDTH_PX, SIDE_PX, HEADER_PX, FOOT_PX = 1400, 40, 130, 76
PATHS = (("mapping", "driven while mapping", LAP_COLOURS[0]),
         ("goals", "driven to the goals", LAP_COLOURS[3]))


def map_picture(ground: Ground, result: Result, title: str, subtitle: str) -> np.ndarray:
    """The picture (rows, columns, 3), BGR."""
    fine = 2  # drawn larger and shrunk, so that letters and curves are smooth
    walls = ground.walls
    low = np.array(walls.origin)
    high = low + np.array(walls.cells.shape[::-1]) * walls.resolution
    house = HouseMap(low - 0.3, high + 0.3, (WIDTH_PX - 2 * SIDE_PX) * fine)
    plan = house.draw_cells(result.map, result.map_in_world)
    house.draw_true_walls(plan, walls, fine)
    for part, _, colour in PATHS:
        house.draw_path(plan, result.paths.get(part, np.empty((0, 2))), colour, 2 * fine)
    ways = result.navigation.ways if result.navigation else []
    for number, way in enumerate(ways, start=1):
        house.draw_goal(plan, np.array(way.goal), str(number), GOAL if way.reached else MISSED,
                        fine)
    rows = house.height_px + (HEADER_PX + FOOT_PX) * fine
    page = np.full((rows, WIDTH_PX * fine, 3), PAPER, np.uint8)
    top, left = HEADER_PX * fine, SIDE_PX * fine
    page[top:top + house.height_px, left:left + house.width_px] = plan
    write_text(page, title, (left, 62 * fine), 26 * fine)
    write_text(page, subtitle, (left, 102 * fine), 13 * fine, FAINT)
    _draw_legend(page, (left, top + house.height_px + 42 * fine), fine)
    _draw_metre(page, house, (page.shape[1] - left, 62 * fine), fine)
    return cv2.resize(page, (WIDTH_PX, rows // fine), interpolation=cv2.INTER_AREA)


def _draw_legend(page: np.ndarray, at_px: tuple[int, int], fine: int) -> None:
    """What the colours mean, on one line."""
    x, y = at_px
    entries = [(WALL, "wall on the map"), (CLEAR, "free on the map"), (TRUE_WALL, "true wall"),
               *((colour, text) for _, text, colour in PATHS), (GOAL, "goal"),
               (MISSED, "not reached")]
    for colour, text in entries:
        draw_line(page, np.array([(x, y - 5 * fine), (x + 26 * fine, y - 5 * fine)]), colour,
                  6 * fine)
        x += 34 * fine
        x += write_text(page, text, (x, y), 12 * fine, FAINT) + 24 * fine


def _draw_metre(page: np.ndarray, house: HouseMap, at_px: tuple[int, int], fine: int) -> None:
    """A metre that ends at a pixel."""
    x, y = at_px
    draw_line(page, np.array([(x - house.px_per_m, y), (x, y)]), FAINT, 2 * fine)
    write_text(page, "1 m", (x - 24 * fine, y - 10 * fine), 12 * fine, FAINT)
