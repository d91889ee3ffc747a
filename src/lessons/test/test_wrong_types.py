"""Parameters of another type than a lesson's program needs: one line names them."""

import importlib.util
from pathlib import Path

import pytest

LESSONS = Path(__file__).resolve().parents[1]
TALKER = "rospy_tutorials/006_parameters/param_talker.py"
GAINS = {"P": 1.0, "I": 2.0, "D": 3.0}


@pytest.fixture
def load(monkeypatch):
    """The module of a program, with these parameters on the server."""
    def load(file, **given):
        spec = importlib.util.spec_from_file_location("program", LESSONS / file)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        monkeypatch.setattr(module.rospy, "get_param", lambda name, *_: given[name.strip("~/")])
        monkeypatch.setattr(module.rospy, "resolve_name",
                            lambda name: name.replace("~", "/node/"))
        for log in ("loginfo", "logfatal"):
            monkeypatch.setattr(module.rospy, log, lambda form, *words: load.said.append(
                form % words if words else form))
        return module

    load.said = []
    return load


@pytest.mark.parametrize(("name", "value", "line"), [
    ("utterance", 5, "the parameter utterance must be a text, not 5"),
    ("topic_name", 5, "the parameter /node/topic_name must be a text, not 5"),
    ("gains", 5, "the parameter gains must be a group with P, I and D, not 5")])
def test_param_talker(load, name, value, line):
    right = {"global_example": 1, "default_param": 1, "utterance": "hi", "topic_name": "chatter",
             "gains": GAINS}
    assert load(TALKER, **right).read() == ("hi", "chatter")
    with pytest.raises(SystemExit) as end:
        load(TALKER, **right | {name: value}).read()
    assert end.value.code == 1 and load.said[-1] == line


def test_own_speed(load):
    solution = "learning_parameter/solutions/own_speed.py"
    assert load(solution, speed=2).speed() == 2
    for value in ("fast", True, [1.0]):
        with pytest.raises(SystemExit, match=r"^/node/speed must be a number in m/s, not "):
            load(solution, speed=value).speed()
