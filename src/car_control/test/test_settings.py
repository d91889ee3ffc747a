"""Settings from files and parameters: what fits, and one clear line for what does not."""

from dataclasses import dataclass
from pathlib import Path

import pytest
from car_control.settings import SettingsError, bounded, explained, load_settings


@dataclass(frozen=True)
class Example:
    speed: float = bounded(0, 5, "m/s")
    active: bool = explained("whether")
    name: str = explained("of what")


GOOD = {"speed": "2", "active": "true", "name": "/car"}


def write(folder, text):
    path = folder / "mine.yaml"
    path.write_text(text)
    return path


def table(**changes):
    lines = {**GOOD, **changes}
    return "".join(f"{key}: {value}\n" for key, value in lines.items() if value is not None)


def test_a_file_and_its_parameters(tmp_path):
    path = write(tmp_path, table())
    assert load_settings(Example, path) == Example(2.0, True, "/car")
    assert load_settings(Example, path, given={"speed": 3, "active": False}).speed == 3.0
    inner = write(tmp_path, "example: {speed: 1.5, active: false, name: x}")
    assert load_settings(Example, inner, "example") == Example(1.5, False, "x")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"sped": 1}, "unknown key 'sped'; known: speed, active, name"),
        ({"speed": None}, "missing key 'speed'"),
        ({"speed": "fast"}, "'speed' must be a number from 0 to 5, not 'fast'"),
        ({"speed": 5.1}, "'speed' must be a number from 0 to 5, not 5.1"),
        ({"speed": ".nan"}, "'speed' must be a number from 0 to 5, not nan"),
        ({"speed": "true"}, "'speed' must be a number from 0 to 5, not True"),
        ({"speed": "1" + "0" * 400}, "'speed' must be a number from 0 to 5, not 1000"),
        ({"active": 1}, "'active' must be true or false, not 1"),
        ({"name": 7}, "'name' must be a text, not 7"),
    ],
)
def test_a_wrong_file_is_named_with_its_key(tmp_path, change, says):
    with pytest.raises(SettingsError) as raised:
        load_settings(Example, write(tmp_path, table(**change)))
    assert says in str(raised.value) and "mine.yaml" in str(raised.value)


@pytest.mark.parametrize("text", ["", "- 1\n", "speed: [1\n", "example: 3\n",
                                  "speed: 2026-13-45", "speed: !!timestamp x",
                                  "speed: !!int ''", "speed: !!bool x", "[" * 1000,
                                  '{"a\\nb": 1}'])
def test_a_file_that_is_no_table_is_one_line(tmp_path, text):
    for section in (None, "example"):
        with pytest.raises(SettingsError) as raised:
            load_settings(Example, write(tmp_path, text), section)
        assert "mine.yaml" in str(raised.value) and "\n" not in str(raised.value)


def test_no_file_at_all(tmp_path):
    with pytest.raises(SettingsError, match=r"nowhere\.yaml: No such file"):
        load_settings(Example, tmp_path / "nowhere.yaml")


def test_a_wrong_parameter_is_named(tmp_path):
    with pytest.raises(SettingsError, match="the node's parameters: unknown key 'x'"):
        load_settings(Example, write(tmp_path, table()), given={"x": 1})


def test_every_table_of_car_control_is_complete_and_explained():
    # The nodes' own tables are loaded in test_motor.py and by the nodes; here: units are said.
    text = (Path(__file__).parents[1] / "config" / "car_control.yaml").read_text()
    keys = [line for line in text.splitlines() if line.startswith("  ")]
    assert keys and all("#" in line for line in keys)
