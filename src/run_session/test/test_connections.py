"""What nodes say of their connections, true or not."""

import threading
from types import SimpleNamespace
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from run_session.connections import _links_of


@pytest.mark.parametrize(("answer", "links"), [
    ([1, "", [[1, "/car", "o", "TCPROS", "/cmd_vel", True]]], [("/me", "/cmd_vel", "/car")]),
    ([1, "", [[1, "/car", "i", "TCPROS", "/cmd_vel", True]]], []),
    ([1, "", [[1, "/car"]]], []),
    ([1, "", 7], []),
    ("no answer", []),
])
def test_an_answer_that_is_none_is_no_link(answer, links):
    with SimpleXMLRPCServer(("localhost", 0), logRequests=False) as server:
        server.register_function(lambda _caller: answer, "getBusInfo")
        thread = threading.Thread(target=server.handle_request)
        thread.start()
        uri = f"http://localhost:{server.server_address[1]}"
        found = _links_of(SimpleNamespace(lookupNode=lambda _node: uri), "/judge", "/me")
        thread.join(60.0)
    assert found == links
