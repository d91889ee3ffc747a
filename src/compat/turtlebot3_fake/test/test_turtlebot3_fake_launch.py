"""The launch file as roslaunch's own loader reads it: rviz where there is a screen."""

from pathlib import Path

import pytest
from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader

FILE = Path(__file__).resolve().parents[1] / "launch" / "turtlebot3_fake.launch"


def rviz(*arguments):
    """The node of that name as (package, type), or None."""
    config = ROSLaunchConfig()
    XmlLoader().load(str(FILE), config, argv=[str(FILE), *arguments], verbose=False)
    return next(((node.package, node.type) for node in config.nodes if node.name == "rviz"), None)


@pytest.mark.parametrize("display, shown", [
    (":0", ("rviz", "rviz")), ("", ("turtlebot3_bringup", "no_screen")),
])
def test_rviz_needs_a_screen(monkeypatch, display, shown):
    monkeypatch.setenv("DISPLAY", display)
    assert rviz() == shown
    assert rviz("open_rviz:=false") is None
