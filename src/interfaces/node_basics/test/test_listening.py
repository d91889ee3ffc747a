"""Whether somebody listens, and to wait for a master."""

import pytest
from node_basics import listening


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
