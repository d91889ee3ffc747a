"""The lane's world: what its ground shows where, its files, mistakes in what it is made from."""

from pathlib import Path

import numpy as np
import pytest
import rospkg
import yaml
from lane_keeping.world.ground import LINE, PX_PER_M, ROAD, WHITE, draw_ground, plane_of
from lane_keeping.world.scenery import load_crossings, load_scenery, person_begin
from node_basics.settings import SettingsError
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import load_track_file

EVALUATION = Path(rospkg.RosPack().get_path("evaluation"))
PACKAGE = Path(__file__).parent.parent
TRACK = load_track_file(EVALUATION / "tracks" / "lane.yaml")
PLANE = plane_of(TRACK)


@pytest.fixture(scope="module")
def ground():
    return draw_ground(TRACK, load_crossings(), None)


def seen(picture, x, y):
    """Colour (RGB) at a place of the world."""
    row = int((PLANE.y + PLANE.height / 2 - y) * PX_PER_M)
    column = int((x - PLANE.x + PLANE.width / 2) * PX_PER_M)
    return picture[row, column].astype(int)


def test_lines_run_beside_the_middle_all_the_way(ground):
    middle = build_track(TRACK)
    for left, colour in ((0.3, LINE), (-0.3, LINE), (0.36, ROAD), (0.24, ROAD)):
        line = middle.offset(left).points(0.5)
        right = [np.abs(seen(ground, *point) - colour).max() < 12 for point in line]
        share = 1 if colour is LINE else 0.85  # zebras have stripes there
        assert np.mean(right) >= share, left


def test_zebras_are_white_and_lie_on_straights(ground):
    middle = build_track(TRACK)
    for zebra in load_crossings().zebras:
        assert np.abs(seen(ground, zebra.x, zebra.y) - WHITE).max() < 12
        nearest = middle.nearest(zebra.x, zebra.y)
        assert abs(nearest.lateral) < 1e-6
        headings = [middle.pose(nearest.s - back)[2] for back in np.arange(0, 1.85, 0.1)]
        assert np.ptp(np.cos(headings)) + np.ptp(np.sin(headings)) < 1e-5
        assert np.allclose((np.cos(headings[0]), np.sin(headings[0])),
                           (np.cos(zebra.heading), np.sin(zebra.heading)), atol=1e-5)


def test_trees_darken_the_ground_where_the_sun_puts_their_shade(ground):
    scenery = load_scenery()
    shaded = draw_ground(TRACK, load_crossings(), scenery)
    for tree in scenery.trees:
        place = scenery.shadow_of(tree.x, tree.y, tree.height)
        assert np.allclose(seen(shaded, *place), seen(ground, *place) * scenery.shade, atol=3)
    assert np.array_equal(seen(shaded, 3.9, 0.0), seen(ground, 3.9, 0.0))


def test_a_person_begins_right_of_the_lane_looking_across():
    crossings = load_crossings()
    assert person_begin(crossings.zebras[0], crossings) == pytest.approx((2.6, -1.4, np.pi / 2))


@pytest.mark.parametrize("values, said", [
    ({"kerb": None}, "missing key 'kerb'"),
    ({"speed": 1}, "unknown key 'speed'"),
    ({"length": "long"}, "length: must be a number, 0 or more, is 'long'"),
    ({"zebras": [{"x": 1, "y": 2}]}, "missing key 'zebras[0].heading'; there are: x, y, heading"),
    ({"zebras": [{"x": 1, "y": 2, "heading": "north"}]}, "zebras[0].heading: must be a number"),
    ({"zebras": 3}, "zebras: must be a list"),
])
def test_a_mistake_in_the_crossings_names_file_and_key(tmp_path, values, said):
    own = PACKAGE / "config" / "crossings.yaml"
    found = yaml.safe_load(own.read_text(encoding="utf-8")) | values
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({k: v for k, v in found.items() if v is not None}))
    with pytest.raises(SettingsError) as caught:
        load_crossings(path)
    assert "mine.yaml" in str(caught.value) and said in str(caught.value)


def test_a_sun_that_shines_upwards_is_refused(tmp_path):
    own = PACKAGE / "config" / "lane_scenery.yaml"
    path = tmp_path / "mine.yaml"
    path.write_text(own.read_text().replace("-0.9]", "0.9]"))
    with pytest.raises(SettingsError, match=r"sun: must be \[x, y, z\] with z below 0"):
        load_scenery(path)
