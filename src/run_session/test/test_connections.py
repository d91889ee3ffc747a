"""What nodes say of their connections, true or not."""

import contextlib
import itertools
import socket
import threading
import time
from types import SimpleNamespace
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from run_session.master import _links_of


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


HEAD = b"HTTP/1.1 200 OK\r\nContent-Type: text/xml\r\n"


@pytest.mark.parametrize("answer", [
    [b"nonsense\r\n\r\n"], [HEAD, b"Content-Length: 3\r\n\r\n<x>"], [HEAD + b"\r\n", b"<a/><b/>"],
    [HEAD + b"\r\n", b"<methodResponse><value></struct></value></methodResponse>"],
    itertools.chain([HEAD], itertools.repeat(b"X: y\r\n")),
    itertools.chain([HEAD + b"\r\n<value>"], itertools.repeat(b" ")),
], ids=["no HTTP", "cut off", "no XML", "no XML-RPC", "an endless head", "an endless body"])
def test_nonsense_and_answers_without_end_are_no_link(answer):
    def babble():
        asker, _ = server.accept()
        with asker, contextlib.suppress(OSError):
            asker.recv(4096)
            for piece in answer:
                asker.sendall(piece)
                ended.wait(0.2)

    ended = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:
        thread = threading.Thread(target=babble)
        thread.start()
        uri = f"http://127.0.0.1:{server.getsockname()[1]}"
        began = time.monotonic()
        assert _links_of(SimpleNamespace(lookupNode=lambda _node: uri), "/judge", "/me") == []
        assert time.monotonic() - began < 30.0
        ended.set()
        thread.join(60.0)
    assert not thread.is_alive()
