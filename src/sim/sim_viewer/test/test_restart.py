"""What goes along when the node starts anew for another master, and what others see of it."""

import asyncio
import os

import yaml
from sim_viewer import node
from sim_viewer import node as viewer_node
from sim_viewer.options import TOKEN, Options, read_options
from sim_viewer.registry import Node

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
