"""Who offers a service on this master, whether somebody listens, and to wait for a master."""

import socket
from types import SimpleNamespace

import pytest
from node_basics import listening, running


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


@pytest.mark.parametrize("uri", ["", "localhost", "http://localhost:x", "http://localhost:99999"])
def test_nobody_listens_at_what_is_no_uri(uri):
    assert not listening.listens(uri)


@pytest.mark.parametrize(("uri", "command"), [
    ("http://localhost:11311", "roscore"), ("http://robot:11430/", "roscore -p 11430"),
    ("http://[::1]:9", "roscore -p 9")])
def test_what_starts_the_master_of_a_uri(uri, command):
    assert listening.roscore(uri) == command


@pytest.mark.parametrize(("looks", "said"), [([True], ""), ([False, False, True], "no master\n")])
def test_without_a_master_it_says_so_once_and_waits(monkeypatch, capsys, looks, said):
    monkeypatch.setattr(listening, "listens", lambda _: looks.pop(0))
    monkeypatch.setattr(listening.time, "sleep", lambda _: None)
    listening.wait_for_master("http://localhost:11311", "no master")
    assert capsys.readouterr().err == said and looks == []
