"""A sensor plugin is its parameters and its message, a drive its tags and its law: few lines."""

import ast
from pathlib import Path

import pytest

import bullet_sim_ros.errors

PLUGINS = Path(bullet_sim_ros.errors.__file__).parent / "plugins"


@pytest.mark.parametrize("name, plugins, most", [
    ("laser", ("LaserPlugin", "BlockLaserPlugin", "RangePlugin"), 30),
    ("hector/sensors", ("HectorSonarPlugin",), 30),
    ("skid_steer_drive", ("SkidSteerDrivePlugin",), 50),
    ("planar_move", ("PlanarMovePlugin",), 50)])
def test_the_examples_of_a_plugin_are_short(name, plugins, most):
    tree = ast.parse((PLUGINS / f"{name}.py").read_text(encoding="utf-8"))
    lines = {node.name: node.end_lineno - node.decorator_list[0].lineno + 1 for node in tree.body
             if isinstance(node, ast.ClassDef) and node.decorator_list}
    assert max(lines[plugin] for plugin in plugins) <= most


def test_headers_are_filled_in_by_one_function():
    package = PLUGINS.parent
    found = [str(path.relative_to(package)) for path in sorted(package.rglob("*.py"))
             if "header.stamp =" in path.read_text(encoding="utf-8")
             or "header.stamp, " in path.read_text(encoding="utf-8")]
    assert found == ["convert.py"]
