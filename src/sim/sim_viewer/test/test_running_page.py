"""What a server that may not be a page says about itself."""

import pytest
from sim_viewer.running_page import ask
from sim_viewer.server import local_url


@pytest.mark.parametrize("port", [99999, -1, "abc", None])
def test_a_port_that_is_none_has_no_page(port):
    assert ask(local_url("127.0.0.1", port)) == {}


@pytest.mark.parametrize("address, host", [
    ("::1", "[::1]"), ("::", "127.0.0.1"), ("0.0.0.0", "127.0.0.1"), ("localhost", "localhost")])
def test_the_url_of_an_address(address, host):
    assert local_url(address, 1) == f"http://{host}:1/"
    assert ask(local_url(address, 1)) == {}
