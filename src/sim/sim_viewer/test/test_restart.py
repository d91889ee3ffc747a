"""The node's parameters go along when it starts anew for another master."""

import yaml
from sim_viewer.options import Options
from sim_viewer.restart import parameter_words


def test_parameters_come_back_as_they_were():
    options = Options(port=8081, control=True, token="0123", hosts=("a", "b"), bags="/data/run 1")
    words = dict(word.split(":=", 1) for word in parameter_words(options))
    read = {name[1:]: yaml.safe_load(value) for name, value in words.items()}  # as rospy reads them
    assert read == {"port": 8081, "address": "127.0.0.1", "control": True, "token": "0123",
                    "hosts": "a,b", "bags": "/data/run 1", "open": False}
