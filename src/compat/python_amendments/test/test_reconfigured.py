"""`dynparam set`: what the node has not taken is said with the range, and exit code 1."""

import sys
from types import SimpleNamespace

import pytest
from python_amendments import reconfigured

DISTANCE = {"name": "wanted_distance", "type": "double", "min": 0.1, "max": 20.0, "edit_method": ""}
WINDOW = {"name": "window", "type": "bool", "min": False, "max": True, "edit_method": ""}


class Client:
    """As upstream's, for a node that takes at most `most`."""

    name, most, sent = "/tracker", 20.0, ()

    def get_parameter_descriptions(self):
        return [DISTANCE, WINDOW]

    def update_configuration(self, changes):
        self.sent = dict(changes)
        if "wanted_distance" in changes:
            changes["wanted_distance"] = float(changes["wanted_distance"])
        taken = {name: max(0.1, min(value, self.most)) if name == "wanted_distance" else value
                 for name, value in changes.items()}
        return {"wanted_distance": 1.0, "window": True} | taken


@pytest.fixture
def client(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["/usr/lib/dynamic_reconfigure/dynparam", "set"])
    kind = type("Client", (Client,), {"update_configuration": Client.update_configuration})
    reconfigured.amend_client(SimpleNamespace(Client=kind))
    return kind()


@pytest.mark.parametrize(("changes", "said"), [
    ({"wanted_distance": "-5"}, "wanted_distance is now 0.1, not -5: it must be from 0.1 to 20.0"),
    ({"wanted_distance": 99}, "wanted_distance is now 20.0, not 99: it must be from 0.1 to 20.0"),
    ({"wanted_distance": "far"},
     "wanted_distance must be a number from 0.1 to 20.0, not far"),
    ({"wanted": "1"}, "/tracker has no parameter wanted; there are: wanted_distance, window")])
def test_a_wrong_value(client, changes, said):
    with pytest.raises(SystemExit) as ended:
        client.update_configuration(changes)
    assert ended.value.code == said


def test_what_no_number_is_never_sent(client):
    with pytest.raises(SystemExit):
        client.update_configuration({"window": False, "wanted_distance": "far"})
    assert client.sent == ()


def test_a_value_within_the_range_that_the_node_refuses(client):
    client.most = 2.0
    with pytest.raises(SystemExit) as ended:
        client.update_configuration({"wanted_distance": "3"})
    assert ended.value.code == ("wanted_distance is still 2.0: the node refuses 3, and says in its "
                                "own terminal why")


def test_a_value_that_is_taken_is_as_ever(client):
    assert client.update_configuration({"wanted_distance": "2", "window": False}) == {
        "wanted_distance": 2.0, "window": False}


def test_another_program_gets_upstreams_answer(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["mine.py"])
    kind = type("Client", (Client,), {})
    reconfigured.amend_client(SimpleNamespace(Client=kind))
    assert kind.update_configuration is Client.update_configuration
