"""The loop of a node's XML-RPC server, which rosgraph itself leaves running."""

import threading
import time

import pytest
from gazebo_ros.spawning import end_quietly
from rosgraph import xmlrpc

LIMIT = 60.0  # s


@pytest.fixture
def _quiet(monkeypatch):
    monkeypatch.setattr(xmlrpc, "ThreadingXMLRPCServer", xmlrpc.ThreadingXMLRPCServer)  # put back
    end_quietly()


@pytest.mark.usefixtures("_quiet")
def test_the_loop_ends_with_the_node():
    node = xmlrpc.XmlRpcNode()
    loop = threading.Thread(target=node.run, daemon=True)
    loop.start()
    end = time.monotonic() + LIMIT
    while not node.uri and time.monotonic() < end:
        time.sleep(0.01)
    node.shutdown("the test is over")
    loop.join(LIMIT)
    assert not loop.is_alive()
