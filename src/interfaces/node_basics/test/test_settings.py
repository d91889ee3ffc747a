"""Settings from files and parameters: what fits, and one clear line for what does not."""

from dataclasses import dataclass

import pytest
from node_basics.settings import SettingsError, choice, count, explained, load_settings, number


@dataclass(frozen=True)
class Example:
    speed: float = number(0, 5, "m/s")
    active: bool = explained("whether")
    name: str = explained("of what")
    turns: int = count(1, 9, "until it stops")
    way: str = choice("left", "right")

    def __post_init__(self):
        if self.name == "/taken":
            raise ValueError("'name' is taken")


GOOD = {"speed": "2", "active": "true", "name": "/car", "turns": "3", "way": "left"}


def write(folder, text):
    path = folder / "mine.yaml"
    path.write_text(text)
    return path


def table(**changes):
    lines = {**GOOD, **changes}
    return "".join(f"{key}: {value}\n" for key, value in lines.items() if value is not None)


def test_a_file_and_its_parameters(tmp_path):
    path = write(tmp_path, table())
    assert load_settings(Example, path) == Example(2.0, True, "/car", 3, "left")
    assert load_settings(Example, path, given={"speed": 3, "active": False}).speed == 3.0
    inner = write(tmp_path, "example: {speed: 1.5, active: false, name: x, turns: 1, way: right}")
    assert load_settings(Example, inner, "example") == Example(
        1.5, False, "x", 1, "right")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"sped": 1}, "unknown key 'sped'; there are: speed, active, name"),
        ({"speed": None}, "missing key 'speed'"),
        ({"speed": "fast"}, "'speed' must be a number from 0 to 5, not 'fast'"),
        ({"speed": 5.1}, "'speed' must be a number from 0 to 5, not 5.1"),
        ({"speed": ".nan"}, "'speed' must be a number from 0 to 5, not nan"),
        ({"speed": "true"}, "'speed' must be a number from 0 to 5, not True"),
        ({"speed": "1" + "0" * 400}, "'speed' must be a number from 0 to 5, not 1000"),
        ({"active": 1}, "'active' must be true or false, not 1"),
        ({"name": 7}, "'name' must be a text, not 7"),
        ({"name": "/taken"}, "and the node's parameters: 'name' is taken"),
        ({"turns": 1.5}, "'turns' must be a whole number from 1 to 9, not 1.5"),
        ({"turns": "true"}, "'turns' must be a whole number from 1 to 9, not True"),
        ({"way": "up"}, "'way' must be one of left, right, not 'up'"),
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
