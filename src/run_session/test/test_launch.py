"""When roscore is up, and that simulated time goes on."""

import threading
import time
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from run_session.failure import RunError
from run_session.launch import Launched
from run_session.master import free_port, is_up
from run_session.processes import Family


@pytest.fixture
def master():
    """A master that has these parameters, and its address."""
    server = SimpleXMLRPCServer(("localhost", 0), logRequests=False)
    parameters = set()
    server.register_function(lambda _caller: (1, "", 4711), "getPid")
    server.register_function(lambda _caller, key: (1, key, key in parameters), "hasParam")
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield parameters, f"http://localhost:{server.server_address[1]}"
    server.shutdown()
    thread.join()
    server.server_close()


def test_a_master_whose_roscore_has_not_named_the_run_is_not_up_yet(master):
    parameters, address = master
    assert not is_up(address)
    parameters.add("/run_id")
    assert is_up(address)


def test_where_nobody_listens_nothing_is_up():
    assert not is_up(f"http://localhost:{free_port()}")


def test_time_that_stands_still_ends_the_run(tmp_path):
    with Family() as family:
        launched = Launched(family, tmp_path / "log")
        launched.start("course", ["sleep", "100"])
        for now in (1.0, 1.0, 2.0):
            launched.check_time(now, 60.0)
        until = time.monotonic() + 60.0
        with pytest.raises(RunError, match=r"stood still at 2\.0 s for"):
            while time.monotonic() < until:
                launched.check_time(2.0, 0.05)
