"""A sensor plugin is its parameters and its message, a drive its tags and its law: few lines."""

from pathlib import Path

import pytest

import bullet_sim_ros.errors

PLUGINS = Path(bullet_sim_ros.errors.__file__).parent / "plugins"


@pytest.mark.parametrize("name, most", [
    ("laser", 40), ("range", 40), ("hector/sonar", 40), ("skid_steer_drive", 60),
    ("planar_move", 60)])
def test_the_examples_of_a_plugin_are_short(name, most):
    text = (PLUGINS / f"{name}.py").read_text(encoding="utf-8")
    assert "@plugin(" in text
    assert len(text.splitlines()) <= most


def test_headers_are_filled_in_by_one_function():
    package = PLUGINS.parent
    found = [str(path.relative_to(package)) for path in sorted(package.rglob("*.py"))
             if "header.stamp =" in path.read_text(encoding="utf-8")
             or "header.stamp, " in path.read_text(encoding="utf-8")]
    assert found == ["convert.py"]
