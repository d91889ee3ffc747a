"""Parameters of controllers from the server; the registry."""

import pytest

from bullet_sim.errors import PluginError
from bullet_sim_ros import params
from bullet_sim_ros.control import (
    controllers,  # noqa: F401  (they register)
    registry,
)


def test_who_did_not_load_the_file_is_told_how(monkeypatch):
    monkeypatch.setattr(params, "below", {"/r/c": {"joint": "a"}}.get)
    p = params.of_controllers("/r/c")
    assert p.text("joint") == "a"
    for read, above in ((lambda: p.number("pid/d"), "/r"),
                        (lambda: p.group("pid").number("d"), "/r/c"),
                        (lambda: params.of_controllers("/c").text("joint"), "/")):
        with pytest.raises(PluginError, match=rf"is not set; was the controller's YAML file loaded "
                                              rf"there \(rosparam load FILE {above}\)\?$"):
            read()


def test_every_registered_type_has_what_a_controller_needs():
    assert len(registry.types()) >= 11
    for kind in registry.types():
        made = registry.find(kind)
        assert issubclass(made, registry.Controller), kind
        assert made.__doc__, kind
    assert registry.hint("effort_controllers/JointPositonController") == (
        " (did you mean effort_controllers/JointPositionController?)")
