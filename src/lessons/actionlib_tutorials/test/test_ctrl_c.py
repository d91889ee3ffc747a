"""The Python clients, ended while they wait: nothing is said that is not so."""

import importlib.machinery
import importlib.util
from pathlib import Path

import pytest
import rospy

LESSONS = Path(__file__).resolve().parents[2]


class Client:
    """What a client is after Ctrl-C; it gets as far as `waits` says."""

    waits = ()

    def __init__(self, *_):
        self._waits = list(self.waits)

    def wait_for_server(self):
        return self._waits.pop(0)

    def wait_for_result(self, *_):
        return self._waits.pop(0)

    def send_goal(self, _goal):
        assert self._waits, "a goal is sent although the node has ended"

    def get_result(self):
        return None


@pytest.fixture(params=[[False], [True, False]], ids=["for the server", "for the result"])
def ended(request, monkeypatch):
    """Loads a script whose client is ended while it waits."""
    def load(path):
        loader = importlib.machinery.SourceFileLoader("client", str(LESSONS / path))
        script = importlib.util.module_from_spec(
            importlib.util.spec_from_loader("client", loader))
        loader.exec_module(script)
        monkeypatch.setattr(Client, "waits", request.param)
        monkeypatch.setattr(script.actionlib, "SimpleActionClient", Client)
        monkeypatch.setattr(rospy, "init_node", lambda *_: None)
        monkeypatch.setattr(rospy, "is_shutdown", lambda: True)
        return script
    return load


def test_fibonacci(ended):
    with pytest.raises(rospy.ROSInterruptException):
        ended("actionlib_tutorials/scripts/fibonacci_client.py").main()


def test_shape(ended, monkeypatch):
    said = []
    monkeypatch.setattr(rospy, "loginfo", lambda text, *_: said.append(text))
    ended("turtle_actionlib/scripts/shape_client").main()
    assert not [text for text in said if "time out" in text]
