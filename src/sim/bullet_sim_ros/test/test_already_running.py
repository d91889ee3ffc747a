"""Which node is there, by what it answers itself: a master and nodes of the test's own."""

import os
import socket
import threading
from contextlib import contextmanager
from socketserver import StreamRequestHandler, TCPServer
from xmlrpc.server import SimpleXMLRPCServer

import psutil
import pytest

from bullet_sim_ros import already_running
from bullet_sim_ros.already_running import Sign, registering, sign_of_life, without_terminal

LIMIT = 60.0  # s
NAME = "/gazebo"


@contextmanager
def serving(server):
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}/"
    finally:
        server.shutdown()
        server.server_close()
        thread.join(LIMIT)


def xmlrpc_server(**functions):
    server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
    for name, function in functions.items():
        server.register_function(function, name)
    return server


def sign(registered):
    """The sign of life of /gazebo, which the master has at this URI; None: it has no such node."""
    answer = [1, "", registered] if registered else [-1, "unknown node", ""]
    with serving(xmlrpc_server(lookupNode=lambda _caller, _node: answer)) as master:
        return sign_of_life(master, NAME)


def test_nobody_of_that_name():
    assert sign(None) is Sign.GONE


def test_a_node_that_was_killed_and_is_still_registered():
    with socket.create_server(("127.0.0.1", 0)) as closed:
        port = closed.getsockname()[1]
    assert sign(f"http://127.0.0.1:{port}/") is Sign.GONE


@pytest.mark.parametrize(("node", "expected"), [
    (xmlrpc_server(getName=lambda _: [1, "", NAME]), Sign.ANSWERS),
    (xmlrpc_server(getName=lambda _: [1, "", "/another"]), Sign.GONE),
    (xmlrpc_server(getPid=lambda _: [1, "", 4711]), Sign.ANSWERS)])  # not rospy's: real Gazebo
def test_who_answers_at_the_address(node, expected):
    with serving(node) as uri:
        assert sign(uri) is expected


@pytest.mark.parametrize(("has_terminal", "its_pid", "parent", "lacks"), [
    (None, os.getpid, 7, True), (os.getpid, os.getpid, 7, False),
    (os.getppid, os.getpid, 7, False),  # a verb, which starts its programs in sessions of their own
    (os.getpid, os.getpid, 1, False),
    (os.getppid, os.getpid, 1, True),  # the shell of `docker run -it` has inherited it
    (None, os.getppid, 7, False)])  # it has no such port: a number of another machine
def test_a_node_without_a_terminal(monkeypatch, has_terminal, its_pid, parent, lacks):
    pid, with_terminal = its_pid(), has_terminal() if has_terminal else None
    monkeypatch.setattr(psutil.Process, "terminal",
                        lambda self: "/dev/pts/3" if self.pid == with_terminal else None)
    monkeypatch.setattr(psutil.Process, "parents", lambda self: [psutil.Process(os.getppid())])
    monkeypatch.setattr(psutil.Process, "ppid", lambda self: parent)
    monkeypatch.setattr(os, "getsid", lambda pid: pid)
    with (serving(xmlrpc_server(getPid=lambda _: [1, "", pid])) as node,
          serving(master_of(node)) as master):
        assert without_terminal(master, NAME) == ([pid] if lacks else [])


def master_of(node):
    """A master in this process, with /gazebo at this URI and a node that has ended."""
    return xmlrpc_server(
        lookupNode=lambda _caller, name: [1, "", node] if name == NAME else [-1, "unknown", ""],
        getSystemState=lambda _: [1, "", [[["/clock", [NAME, "/gone"]]], [], []]],
        getPid=lambda _: [1, "", os.getpid()])


def test_a_roslaunch_without_a_terminal_ends_what_it_started(monkeypatch):
    monkeypatch.setattr(psutil.Process, "terminal", lambda _: None)
    monkeypatch.setattr(psutil.Process, "ppid", lambda _: 7)
    monkeypatch.setattr(psutil.Process, "parents", lambda _: [psutil.Process(os.getppid())])
    monkeypatch.setattr(psutil.Process, "cmdline", lambda self: [
        "python3", "/usr/bin/roslaunch" if self.pid == os.getppid() else "node"])
    with (serving(xmlrpc_server(getPid=lambda _: [1, "", os.getpid()])) as node,
          serving(master_of(node)) as master):
        assert without_terminal(master, NAME) == [os.getppid()]


def test_a_machine_whose_name_is_not_known_may_have_it():
    assert sign("http://no-such-machine.invalid:4711/") is Sign.UNKNOWN


def test_a_master_that_hangs_ends_the_question(monkeypatch):
    monkeypatch.setattr(already_running, "ANSWER_TIME", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent, pytest.raises(TimeoutError):
        sign_of_life(f"http://127.0.0.1:{silent.getsockname()[1]}/", NAME)


def test_a_port_that_has_another_program_by_now():
    class Greeting(StreamRequestHandler):
        def handle(self):
            self.wfile.write(b"220 a mail server\r\n")

    with serving(TCPServer(("127.0.0.1", 0), Greeting)) as uri:
        assert sign(uri) is Sign.GONE


def test_a_node_that_hangs_is_still_there(monkeypatch):
    monkeypatch.setattr(already_running, "ANSWER_TIME", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        assert sign(f"http://127.0.0.1:{silent.getsockname()[1]}/") is Sign.HANGS


def test_without_a_master_it_raises():
    with socket.create_server(("127.0.0.1", 0)) as closed:
        port = closed.getsockname()[1]
    with pytest.raises(OSError, match="refused"):
        sign_of_life(f"http://127.0.0.1:{port}/", NAME)


def test_one_registers_after_the_other_and_other_names_do_not_wait():
    second_is_in, first_left = threading.Event(), []

    def second():
        with registering("http://a:1/", NAME):
            second_is_in.set()

    other = threading.Thread(target=second)
    with registering("http://a:1/", NAME):
        other.start()
        with registering("http://a:1/", "/two/gazebo"), registering("http://a:2/", NAME):
            assert not second_is_in.wait(0.2)
        first_left.append(True)
    assert second_is_in.wait(LIMIT) and first_left
    other.join(LIMIT)


def test_one_that_hangs_while_it_registers_does_not_block_for_ever(monkeypatch):
    monkeypatch.setattr(already_running, "TURN_TIME", 0.1)
    with registering("http://a:1/", NAME), registering("http://a:1/", NAME):
        pass
