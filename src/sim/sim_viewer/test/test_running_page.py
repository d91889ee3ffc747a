"""Which page or simulator runs, and what goes along when the node starts anew."""

import asyncio
import os
from dataclasses import asdict

import pytest
import yaml
from sim_viewer import node, running_page
from sim_viewer import node as viewer_node
from sim_viewer.options import TOKEN, Options, read_options
from sim_viewer.registry import Node
from sim_viewer.running_page import ask
from sim_viewer.tools.master import SystemState, simulator_name
from sim_viewer.urls import local_url

from bullet_sim_ros.already_running import Sign


@pytest.mark.parametrize("port", [99999, -1, "abc", None])
def test_a_port_that_is_none_has_no_page(port):
    assert ask(local_url("127.0.0.1", port)) == {}


@pytest.mark.parametrize("address, host", [
    ("::1", "[::1]"), ("::", "127.0.0.1"), ("0.0.0.0", "127.0.0.1"), ("localhost", "localhost")])
def test_the_url_of_an_address(address, host):
    assert local_url(address, 1) == f"http://{host}:1/"
    assert ask(local_url(address, 1)) == {}


@pytest.mark.parametrize("sign, said", [
    (Sign.GONE, ()), (Sign.UNKNOWN, ()), (Sign.HANGS, (running_page.HANGS, "http://there:8080/")),
    (Sign.ANSWERS, (running_page.RUNS_ALREADY, "http://there:8080/"))])
def test_a_page_starts_unless_one_answers_or_hangs(monkeypatch, sign, said):
    for name, found in (("_wished", asdict(Options())), ("sign_of_life", sign), ("ask", {}),
                        ("_url", "http://there:8080/")):
        monkeypatch.setattr(running_page, name, lambda *_, found=found: found)
    monkeypatch.setattr(running_page.rosgraph, "is_master_online", lambda _uri: True)
    assert running_page.running_page("sim_viewer", "") == said


@pytest.mark.parametrize(("services", "name"), [
    ([], "/gazebo"),
    (["/gazebo/pause_physics", "/a/gazebo/pause_physics"], "/gazebo"),
    (["/arena/sim/pause_physics", "/arena/sim/reset_world"], "/arena/sim"),
])
def test_the_one_that_can_be_paused(services, name):
    assert simulator_name(SystemState({}, {}, {one: ["/n"] for one in services})) == name


OPTIONS = Options(port=8081, control=True, token="0123", hosts=("a", "b"), bags="/data/run 1",
                  rviz="/a b.rviz")


def test_parameters_come_back_as_they_were(monkeypatch):
    started = []
    monkeypatch.setattr(node.os, "execve", lambda *given: started.append(given))
    node.restart(OPTIONS, 8082)
    (_, words, environment), = started
    assert "0123" not in " ".join(words)  # `ps` shows them to all
    given = dict(word.split(":=", 1) for word in words if word.startswith("_") and ":=" in word)
    read = {name[1:]: yaml.safe_load(value) for name, value in given.items()}  # as rospy reads them
    assert read == {"port": 8082, "address": "127.0.0.1", "control": True,
                    "hosts": "a,b", "bags": "/data/run 1", "open": False, "rviz": "/a b.rviz"}
    monkeypatch.setattr(os, "environ", environment)
    monkeypatch.setattr("rospy.get_param", lambda name, *default: read.get(name[1:], *default))
    assert environment[TOKEN] == "0123" and read_options().token == "0123"


def test_the_master_does_not_learn_the_token(monkeypatch, capsys):
    said = {}
    monkeypatch.setattr(viewer_node.rospy, "set_param", said.__setitem__)

    async def announce():
        node = Node(OPTIONS, asyncio.get_running_loop())
        await viewer_node._announce(node, 8081)
        node.close()

    asyncio.run(announce())
    assert said == {"~url": "http://127.0.0.1:8081/"}
    assert "viewer: http://127.0.0.1:8081/?token=0123#rviz\n" in capsys.readouterr().out
