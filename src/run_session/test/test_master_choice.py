"""Which master a command uses, by what the caller has set and who listens where."""

import os
import socket
import subprocess
import threading
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from run_session import master
from run_session.master import (
    CALLERS,
    USUAL,
    USUAL_PORT,
    free_port,
    is_up,
    listens_here,
    own_port,
    wait_for_simulator,
)


@pytest.fixture
def callers(monkeypatch):
    """Set the caller's ROS_MASTER_URI, as scripts/common.sh does."""
    monkeypatch.setenv("ROS_MASTER_URI", USUAL)
    return lambda uri: monkeypatch.setenv(CALLERS, uri)


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1", socket.gethostname()])
def test_a_free_port_of_this_machine_is_kept(callers, host):
    port = free_port(0)
    callers(f"http://{host}:{port}/")
    assert own_port() == (port, ())


@pytest.mark.parametrize("uri", ["", USUAL, USUAL + "/"])
def test_what_setup_bash_sets_is_no_choice(callers, uri):
    callers(uri)
    assert own_port()[1] == ()


@pytest.mark.parametrize(("joined", "port"), [(False, 0), (True, USUAL_PORT)])
def test_only_what_other_terminals_join_takes_the_usual_port(callers, monkeypatch, joined, port):
    callers("")
    monkeypatch.setattr(master, "free_port", lambda wished=USUAL_PORT: wished)  # 0: any
    assert own_port(joined) == (port, ())


def test_one_that_is_taken_is_said(callers):
    with socket.create_server(("localhost", 0)) as other:
        taken = other.getsockname()[1]
        callers(f"http://localhost:{taken}")
        port, (form, uri) = own_port()
    assert port != taken
    assert form % uri == (
        f"ROS_MASTER_URI=http://localhost:{taken} is not used: something listens there already, "
        "and this command starts a ROS master of its own")


@pytest.mark.parametrize("uri", ["http://192.0.2.7:11311", "http://192.0.2.7", "http://x:y"])
def test_one_of_another_machine_is_said(callers, uri):
    callers(uri)
    _, why = own_port()
    assert why[0] % why[1:] == (f"ROS_MASTER_URI={uri} is not used: this command starts a ROS "
                                "master of its own, on this machine")


def test_a_program_that_was_started_by_hand_is_asked_for_its_own_variable(monkeypatch):
    monkeypatch.delenv(CALLERS, raising=False)
    port = free_port(0)
    monkeypatch.setenv("ROS_MASTER_URI", f"http://localhost:{port}")
    assert own_port() == (port, ())


def test_who_listens():
    with socket.create_server(("localhost", 0)) as here:
        port = here.getsockname()[1]
        assert listens_here(port)
    assert not listens_here(port)


def test_another_users_process_is_not_ours(monkeypatch):
    with socket.create_server(("localhost", 0)) as here:
        monkeypatch.setattr(os, "getuid", lambda: -1)
        assert not listens_here(here.getsockname()[1])


@pytest.mark.parametrize(("listens", "up", "joined"), [
    (True, True, True), (True, False, False), (False, True, False)])
def test_only_a_master_of_ones_own_is_joined(monkeypatch, listens, up, joined):
    monkeypatch.setattr(master, "listens_here", lambda _port: listens)
    monkeypatch.setattr(master, "is_up", lambda _uri: up)
    monkeypatch.setattr(master, "free_port", lambda: 40123)
    expected = USUAL if joined else "http://localhost:40123"
    assert master.master_to_join() == expected


def test_another_programs_answer_is_no_masters():
    server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
    server.register_function(lambda _caller, _key: 7, "hasParam")
    thread = threading.Thread(target=server.handle_request)
    with server:
        thread.start()
        assert not is_up(f"http://127.0.0.1:{server.server_address[1]}/")
        thread.join()


@pytest.fixture
def master_without_simulator(monkeypatch):
    """A master whose first three answers are that nobody has the service."""
    asked = []

    def look_up(_, service):
        asked.append(service)
        return (1, "", "rosrpc://localhost:1") if len(asked) > 3 else (-1, "no provider", "")

    with SimpleXMLRPCServer(("localhost", 0), logRequests=False) as server:
        server.register_function(look_up, "lookupService")
        threading.Thread(target=server.serve_forever, daemon=True).start()
        monkeypatch.setenv("ROS_MASTER_URI", f"http://localhost:{server.server_address[1]}")
        monkeypatch.setattr(master, "POLL_PERIOD", 0.01)
        yield asked
        server.shutdown()


def test_the_simulator_is_awaited(master_without_simulator):
    assert wait_for_simulator(os.getpid())
    assert master_without_simulator == ["/gazebo/get_world_properties"] * 4


@pytest.mark.parametrize("reaped", [True, False])
def test_no_longer_than_its_process_is_there(master_without_simulator, monkeypatch, reaped):
    monkeypatch.setattr(master, "_has_simulator", lambda _: False)
    with subprocess.Popen(["true"]) as process:
        if reaped:
            process.wait()
        assert not wait_for_simulator(process.pid)


def test_without_a_master_the_process_is_awaited(monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", f"http://localhost:{free_port(0)}")
    with subprocess.Popen(["sleep", "0.3"]) as process:
        assert not wait_for_simulator(process.pid)
