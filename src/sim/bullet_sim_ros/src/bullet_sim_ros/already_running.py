"""Finds a node that runs already, before rospy registers another one under its name.

The master has one node for each name: if a second one registers, the master ends the first. It also
keeps the names of nodes that were killed, so a registered node is asked for a sign of life.
"""

import contextlib
import errno
import hashlib
import http.client
import os
import socket
import sys
import threading
import time
import xmlrpc.client
from collections.abc import Iterator
from contextlib import contextmanager
from enum import Enum
from pathlib import Path
from urllib.parse import urlsplit
from xml.parsers.expat import ExpatError

import psutil
from node_basics.listening import listens
from rosgraph.names import get_ros_namespace, load_mappings, ns_join, resolve_name

from bullet_sim_ros.names import CLOCK

ANSWER_TIME = 2.0  # s, wall, for a connection and for an answer
TURN_TIME = 15.0  # s, wall; a registration takes 0.1 s
LOOK_PERIOD = 0.02  # s, wall
LAUNCHERS = {"roslaunch", "roscore"}


class Sign(Enum):
    """What is known of a node."""

    GONE = "not registered, or registered by a process that has ended"
    HANGS = "takes a connection, and does not answer"
    UNKNOWN = "registered by another machine, whose name this one does not know"
    ANSWERS = "runs"


def full_name(default: str) -> str:
    """The name that rospy.init_node(default) will register, before it does so."""
    name = load_mappings(sys.argv).get("__name", default)
    return resolve_name(name, ns_join(get_ros_namespace(), name))


def may_simulate(master_uri: str) -> bool:
    """Whether /clock has a publisher there, or a node's name is a simulator's, which it has before
    it publishes; False without a master."""
    master = xmlrpc.client.ServerProxy(master_uri, ImpatientTransport(ANSWER_TIME))
    try:
        _, _, (publishers, _, _) = master.getSystemState("/roslaunch")
    except (OSError, http.client.HTTPException, xmlrpc.client.Error, ExpatError, TypeError,
            ValueError):
        return False
    return any(name == CLOCK or any(node.endswith("/gazebo") for node in nodes)
               for name, nodes in publishers)


def sign_of_life(master_uri: str, name: str) -> Sign:
    """Ask the node of this full name itself; OSError if there is no master."""
    master = xmlrpc.client.ServerProxy(master_uri, ImpatientTransport(ANSWER_TIME))
    code, _, uri = master.lookupNode(name, name)
    if code != 1:
        return Sign.GONE
    try:
        socket.getaddrinfo(urlsplit(uri).hostname, None)
    except OSError:
        return Sign.UNKNOWN
    if not listens(uri):
        return Sign.GONE
    try:
        _, _, told = xmlrpc.client.ServerProxy(uri, ImpatientTransport(ANSWER_TIME)).getName(name)
    except TimeoutError:
        return Sign.HANGS
    except xmlrpc.client.Fault:  # a node, but not one of rospy
        return Sign.ANSWERS
    except (OSError, http.client.HTTPException, xmlrpc.client.Error, ExpatError, TypeError,
            ValueError):
        return Sign.GONE  # its port is another program's by now
    return Sign.ANSWERS if told == name else Sign.GONE


def without_terminal(master_uri: str, name: str) -> list[int]:
    """What to kill where a node runs on this machine without a terminal, so that no Ctrl-C can end
    it, as after `kill -9` of its roslaunch: its process, those of the other such nodes and of the
    master, or the roslaunch that they still have. None if it has a terminal.
    """
    master = xmlrpc.client.ServerProxy(master_uri, ImpatientTransport(ANSWER_TIME))
    own = _without_terminal(master.lookupNode(name, name)[2], name)
    if own is None:
        return []
    names = {node for kind in master.getSystemState(name)[2] for _, nodes in kind for node in nodes}
    uris = [master_uri, *(master.lookupNode(name, node)[2] for node in sorted(names))]
    return sorted({own, *(_without_terminal(uri, name) for uri in uris)} - {None})


def _without_terminal(uri: str, caller: str) -> int | None:
    """The process of the node or master at this URI, or the roslaunch that it has; None if it has
    a terminal. A program in a terminal, such as make, may have started that roslaunch in a session
    of its own.
    """
    with contextlib.suppress(psutil.Error, OSError, xmlrpc.client.Error, ExpatError, TypeError,
                             ValueError):
        node = xmlrpc.client.ServerProxy(uri, ImpatientTransport(ANSWER_TIME))
        process = psutil.Process(node.getPid(caller)[2])
        if urlsplit(uri).port not in {one.laddr.port for one in process.net_connections("tcp")}:
            return None  # a number of another machine, or of a container
        orphaned = psutil.Process(os.getsid(process.pid)).ppid() == 1  # whose terminal is another's
        above = () if orphaned else process.parents()
        if not any(each.terminal() for each in (process, *above)):
            return next((each.pid for each in above if LAUNCHERS & {
                Path(word).name for word in each.cmdline()[:2]}), process.pid)
    return None


@contextmanager
def registering(master_uri: str, name: str) -> Iterator[None]:
    """Of several processes of this machine that look for this node, and else become it, one is in
    here at a time. An abstract socket: the kernel releases it when its process dies.
    """
    text = f"{urlsplit(master_uri).port} {name}"
    address = "\0ros-node-" + hashlib.sha256(text.encode()).hexdigest()
    until = time.monotonic() + TURN_TIME
    with socket.socket(socket.AF_UNIX) as turn:
        while True:
            try:
                turn.bind(address)
                break
            except OSError as error:
                if error.errno != errno.EADDRINUSE or time.monotonic() > until:
                    break  # its holder hangs: better two than none
            time.sleep(LOOK_PERIOD)
        yield


class ImpatientTransport(xmlrpc.client.Transport):
    """Gives up after `seconds` with a TimeoutError: a node may hang, or answer without end."""

    def __init__(self, seconds: float) -> None:
        super().__init__()
        self._seconds = seconds

    def make_connection(self, host: str) -> http.client.HTTPConnection:
        self._connection = host, _Connection(host, timeout=self._seconds)
        return self._connection[1]

    def single_request(self, *request: object, **options: object) -> object:
        """One call and its answer; TimeoutError if that takes longer."""
        over = threading.Event()
        limit = threading.Timer(self._seconds, lambda: (over.set(), self._hang_up()))
        limit.start()
        try:
            return super().single_request(*request, **options)
        except (OSError, http.client.HTTPException, xmlrpc.client.Error, ExpatError):
            if over.is_set():
                raise TimeoutError from None
            raise
        finally:
            limit.cancel()

    def _hang_up(self) -> None:
        connection = self._connection[1]
        if connection is not None:  # a connection is made, and has not just ended
            connection.hang_up()


class _Connection(http.client.HTTPConnection):
    """Can be ended while an answer is read, for which HTTPConnection lets its socket go."""

    _connected: socket.socket | None = None

    def connect(self) -> None:
        super().connect()
        self._connected = self.sock

    def hang_up(self) -> None:
        """From another thread: whoever reads then finds the end."""
        if self._connected is not None:
            with contextlib.suppress(OSError):  # it has just ended
                self._connected.shutdown(socket.SHUT_RDWR)
