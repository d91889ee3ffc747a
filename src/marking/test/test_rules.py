"""marking.yaml: each wrong key or value is one line that names file and key."""

from pathlib import Path

import pytest
import yaml
from marking.rules import load_rules

from run_session.failure import RunError

SHIPPED = Path(__file__).parents[1] / "config" / "marking.yaml"


def test_the_shipped_rules_are_worth_100_points():
    assert repr(load_rules(SHIPPED).points.most) == "100.0"  # as marks.csv has it


@pytest.mark.parametrize(("path", "value", "says"), [
    ("corse", "x", "unknown key 'corse'"),
    ("points.line", "much", "points.line: must be a number"),
    ("points.bonus", 3, "unknown key 'points.bonus'"),
    ("limits.wall_s", 0, "limits.wall_s: must be more than 0"),
    ("limits", 3, "missing key 'limits.answer_s'"),
    ("light", [1.2, 0.8], "light"),
    ("seeds", True, "seeds: must be a whole number"),
    ("laps", 0, "laps: must be 1 or more"),
    ("may_call", "/x", "may_call: must be a list of texts"),
    ("points", {**yaml.safe_load(SHIPPED.read_text())["points"], "finish": 0, "line": 0,
                "speed": 0}, "are all 0"),
])
def test_a_mistake_is_one_line_that_names_the_key(tmp_path, path, value, says):
    values = yaml.safe_load(SHIPPED.read_text())
    *above, key = path.split(".")
    holder = values
    for name in above:
        holder = holder[name]
    holder[key] = value
    wrong = tmp_path / "marking.yaml"
    wrong.write_text(yaml.safe_dump(values))
    with pytest.raises(RunError) as refused:
        load_rules(wrong)
    assert says in str(refused.value)
    assert str(wrong) in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_missing_key_is_named(tmp_path):
    values = yaml.safe_load(SHIPPED.read_text())
    del values["limits"]["disk_mb"]
    wrong = tmp_path / "marking.yaml"
    wrong.write_text(yaml.safe_dump(values))
    with pytest.raises(RunError, match=r"missing key 'limits\.disk_mb'"):
        load_rules(wrong)


def test_a_file_from_before_there_was_a_pass_line_passes_with_60_percent(tmp_path):
    values = yaml.safe_load(SHIPPED.read_text())
    del values["pass_points"]
    values["points"] |= {"finish": 6, "line": 3, "speed": 1}
    old = tmp_path / "old.yaml"
    old.write_text(yaml.safe_dump(values))
    assert load_rules(old).pass_points == 6.0
    old.write_text(yaml.safe_dump(values | {"pass_points": 11}))
    with pytest.raises(RunError, match="pass_points: must be 10 or less"):
        load_rules(old)
