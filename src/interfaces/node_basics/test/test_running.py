"""Who offers a service on this master."""

import socket
from types import SimpleNamespace

import pytest
from node_basics import running


@pytest.mark.parametrize("service, who, expected", [
    ("gazebo/x", lambda: running.simulators("x"), "/a/gazebo"),
    ("gazebo/spawn_urdf_model", running.simulators, "/a/gazebo"),
    ("arm/x", lambda: running.offering("/arm/x"), "/a")])
def test_what_was_killed_does_not_count(monkeypatch, service, who, expected):
    with socket.create_server(("localhost", 0)) as alive, socket.socket() as dead:
        dead.bind(("localhost", 0))
        ports = {f"/{name}/{service}": each.getsockname()[1]
                 for name, each in (("a", alive), ("b", dead))}
        master = SimpleNamespace(
            getSystemState=lambda: ([], [], [[name, [f"node of {name}"]] for name in ports]),
            lookupNode=lambda node: f"http://localhost:{ports[node.removeprefix('node of ')]}/")
        monkeypatch.setattr(running.rosgraph, "Master", lambda _: master)
        assert who() == [expected]
