"""What a server that may not be a page says about itself."""

from dataclasses import asdict

import pytest
from sim_viewer import running_page
from sim_viewer.options import Options
from sim_viewer.running_page import ask
from sim_viewer.server import local_url

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
