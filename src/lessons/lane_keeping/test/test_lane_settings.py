"""The shipped settings files load, and each mistake in one is a line that names file and key."""

from pathlib import Path

import pytest
import yaml
from lane_keeping.methods import method_called
from lane_keeping.settings import METHODS, SettingsError, load_settings

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


@pytest.mark.parametrize(("change", "complaint"), [
    ({"speeed": 1}, "unknown key 'speeed'; known: method, "),
    ({"method": "magic"}, "'method' must be one of sliding_windows, "),
    ({"windows": 9.5}, "'windows' must be a whole number from 3 to 40, not 9.5"),
    ({"steer_gain": 10**400}, "'steer_gain' must be a number from 0 to 20, not 1000"),
    ({"steer_gain": "much"}, "'steer_gain' must be a number from 0 to 20, not 'much'"),
    ({"max_turn": float("nan")}, "'max_turn' must be a number from 0.1 to 10, not nan"),
    ({"straight_speed": True}, "'straight_speed' must be a number from 0 to 5, not True"),
    ({"block_px": 10}, "'block_px' must be odd, not 10"),
    ({"windows": None}, "missing key 'windows'"),
])
def test_mistakes_in_a_file(tmp_path, change, complaint):
    table = yaml.safe_load((CONFIG / "page.yaml").read_text(encoding="utf-8")) | change
    path = tmp_path / "bad.yaml"
    kept = {key: value for key, value in table.items() if value is not None}
    path.write_text(yaml.safe_dump(kept), encoding="utf-8")
    with pytest.raises(SettingsError) as caught:
        load_settings(path)
    assert str(caught.value).startswith(str(path)) and complaint in str(caught.value)


def test_files_that_are_none(tmp_path):
    with pytest.raises(SettingsError, match="No such file"):
        load_settings(tmp_path / "none.yaml")
    (tmp_path / "list.yaml").write_text("[1, 2]", encoding="utf-8")
    with pytest.raises(SettingsError, match="not a table of 'key: value' lines"):
        load_settings(tmp_path / "list.yaml")
    (tmp_path / "broken.yaml").write_text("a: [", encoding="utf-8")
    with pytest.raises(SettingsError, match="not valid YAML"):
        load_settings(tmp_path / "broken.yaml")


def test_parameters_win():
    settings = load_settings(FILES[0], {"method": "skeleton", "steer_gain": 3})
    assert (settings.method, settings.steer_gain) == ("skeleton", 3.0)
    with pytest.raises(SettingsError, match="the node's parameters: unknown key 'gain'"):
        load_settings(FILES[0], {"gain": 3})


@pytest.mark.parametrize("text", ["windows: 2026-13-45", "windows: !!timestamp x",
                                  "windows: !!int ''", "windows: !!bool x", "[" * 1000])
def test_what_yaml_itself_trips_over_is_one_line(tmp_path, text):
    path = tmp_path / "odd.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError, match="not valid YAML") as caught:
        load_settings(path)
    assert "\n" not in str(caught.value) and str(path) in str(caught.value)
