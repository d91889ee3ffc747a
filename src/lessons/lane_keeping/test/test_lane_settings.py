"""The shipped settings files load, and a node's parameters override them."""

from pathlib import Path

import pytest
from lane_keeping.methods import method_called
from lane_keeping.settings import METHODS, load_settings
from node_basics.settings import SettingsError

CONFIG = Path(__file__).parents[1] / "config"
FILES = [CONFIG / "lane_keeping.yaml", CONFIG / "page.yaml"]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_shipped_files_load(path):
    assert load_settings(path).method == "sliding_windows"


def test_the_page_file_has_the_pages_numbers():
    page = load_settings(CONFIG / "page.yaml")
    assert (page.binarise, page.block_px, page.adaptive_c) == ("global_mean", 11, 2)
    assert (page.opening_px, page.windows, page.margin_px, page.min_pixels) == (5, 9, 80, 50)
    assert (page.look_ahead, page.steer_gain, page.max_turn) == (0.7, 2, 2)
    assert (page.straight_speed, page.bend_speed) == (1, 0.5)
    assert (page.bend_curvature, page.bend_error) == (0.0005, 0.2)


def test_every_method_has_a_file_and_every_file_is_a_method():
    folder = Path(__file__).parents[1] / "src" / "lane_keeping" / "methods"
    assert sorted(METHODS) == sorted(path.stem for path in folder.glob("[!_]*.py"))
    for name in METHODS:
        assert method_called(name).__name__ == "plan"


def test_parameters_win():
    settings = load_settings(FILES[0], {"method": "skeleton", "steer_gain": 3})
    assert (settings.method, settings.steer_gain) == ("skeleton", 3.0)
    with pytest.raises(SettingsError, match="the node's parameters: unknown key 'gain'"):
        load_settings(FILES[0], {"gain": 3})
    with pytest.raises(SettingsError, match="parameters: 'block_px' must be odd, not 10"):
        load_settings(FILES[0], {"block_px": 10})
