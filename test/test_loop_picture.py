"""README's looping picture: of both cars, small; and how its parts are put together."""

import io
import sys
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).parent.parent / "tools" / "makers"))
from loop_picture import GAP_PX, PANEL_PX, PATH_PX, TITLES, animation, into, lap_picture

from evaluation.course_run import PLAN_PX
from evaluation.film import BAR_PX, VIEW_PX
from evaluation.picture import LEGEND_PX

ROOT = Path(__file__).parent.parent
MOST_BYTES = 3_000_000
LEAST_OF_A_LAP = 20  # pictures
SIZE = PANEL_PX[0] * 2 + PATH_PX[0] + GAP_PX * 2, PANEL_PX[1] + 2 * LEGEND_PX


def test_the_committed_one_loops_is_small_and_shows_a_lap_of_each_car():
    path = ROOT / "docs" / "images" / "course.webp"
    assert path.stat().st_size <= MOST_BYTES
    with Image.open(path) as picture:
        assert (picture.size, picture.info["loop"]) == (SIZE, 0)
        assert picture.n_frames >= LEAST_OF_A_LAP * len(TITLES)
    for page in ("README.md", "README.zh-CN.md"):
        assert "(docs/images/course.webp)" in (ROOT / page).read_text(encoding="utf-8")


def test_camera_outside_and_path_stand_side_by_side():
    page = np.zeros((BAR_PX + VIEW_PX[1] + LEGEND_PX, VIEW_PX[0] + PLAN_PX, 3), np.uint8)
    page[BAR_PX:, :VIEW_PX[0]] = (255, 0, 0)
    page[BAR_PX:, VIEW_PX[0]:] = (0, 0, 255)
    whole = lap_picture("course", page, np.full((400, 750, 3), (0, 255, 0), np.uint8))
    assert whole.shape == (SIZE[1], SIZE[0], 3)
    middle = whole[SIZE[1] // 2]
    assert middle[PANEL_PX[0] // 2].tolist() == [255, 0, 0]
    assert middle[PANEL_PX[0] + GAP_PX + PANEL_PX[0] // 2].tolist() == [0, 255, 0]
    assert middle[-PATH_PX[0] // 2].tolist() == [0, 0, 255]


def test_a_picture_fits_or_covers():
    tall = np.full((300, 100, 3), 255, np.uint8)
    assert into(tall, (40, 30)).shape == into(tall, (40, 30), cover=True).shape == (30, 40, 3)
    assert into(tall, (40, 30))[15, 0].tolist() != [255, 255, 255]
    assert into(tall, (40, 30), cover=True)[15, 0].tolist() == [255, 255, 255]


def test_the_last_picture_of_a_lap_stays():
    made = animation([np.full((8, 8, 3), number, np.uint8) for number in (0, 100, 200)], ends=[1])
    with Image.open(io.BytesIO(made)) as picture:
        stays = []
        for number in range(picture.n_frames):
            picture.seek(number)
            picture.load()
            stays.append(picture.info.get("duration"))
    assert stays == [100, 1500, 100]
