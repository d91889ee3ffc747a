"""Finds a node that runs already, before rospy registers another one under its name.

The master has one node for each name: if a second one registers, the master ends the first. It also
keeps the names of nodes that were killed, so a registered node is asked for a sign of life.
"""

import errno
import hashlib
import http.client
import socket
import sys
import time
import xmlrpc.client
from collections.abc import Iterator
from contextlib import contextmanager
from enum import Enum
from urllib.parse import urlsplit
from xml.parsers.expat import ExpatError

import rosgraph
from rosgraph.names import get_ros_namespace, load_mappings, ns_join, resolve_name

ANSWER_TIME = 2.0  # s, wall, for a connection and for an answer
TURN_TIME = 15.0  # s, wall; a registration takes 0.1 s
LOOK_PERIOD = 0.02  # s, wall


class Sign(Enum):
    """What is known of a node."""

    GONE = "not registered, or registered by a process that has ended"
    HANGS = "takes a connection, and does not answer"
    ANSWERS = "runs"


def full_name(default: str) -> str:
    """The name that rospy.init_node(default) will register, before it does so."""
    name = load_mappings(sys.argv).get("__name", default)
    return resolve_name(name, ns_join(get_ros_namespace(), name))


def is_online(master_uri: str) -> bool:
    """Whether something listens at this URI; no longer than ANSWER_TIME, unlike rosgraph's."""
    try:
        place = urlsplit(master_uri)
        socket.create_connection((place.hostname, place.port), ANSWER_TIME).close()
    except (OSError, TypeError, ValueError):  # the latter two: it is no URI
        return False
    return True


def sign_of_life(master_uri: str, name: str) -> Sign:
    """Ask the node of this full name itself; OSError if there is no master."""
    try:
        uri = rosgraph.Master(name, master_uri).lookupNode(name)
    except rosgraph.MasterException:
        return Sign.GONE
    if not is_online(uri):
        return Sign.GONE
    try:
        _, _, told = xmlrpc.client.ServerProxy(uri, _ImpatientTransport()).getName(name)
    except TimeoutError:
        return Sign.HANGS
    except xmlrpc.client.Fault:  # a node, but not one of rospy
        return Sign.ANSWERS
    except (OSError, http.client.HTTPException, xmlrpc.client.Error, ExpatError, TypeError,
            ValueError):
        return Sign.GONE  # its port is another program's by now
    return Sign.ANSWERS if told == name else Sign.GONE


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


class _ImpatientTransport(xmlrpc.client.Transport):
    def make_connection(self, host: str) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = ANSWER_TIME
        return connection
