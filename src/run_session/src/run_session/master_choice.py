"""Which ROS master a command uses, where the caller has named one or the usual one runs.

As a program, for scripts/common.sh: prints the URI of a master that other terminals can join.
"""

from __future__ import annotations

import contextlib
import os
import socket
import xmlrpc.client
from http.client import HTTPException
from urllib.parse import urlsplit
from xml.parsers.expat import ExpatError

import psutil
from rosgraph.network import is_local_address

from run_session.connections import ImpatientTransport

USUAL_PORT = 11311
USUAL = f"http://localhost:{USUAL_PORT}"  # what sourcing devel/setup.bash sets
CALLERS = "CALLERS_ROS_MASTER_URI"  # set by scripts/common.sh, which clears ROS_MASTER_URI
ELSEWHERE = ("ROS_MASTER_URI=%s is not used: this command starts a ROS master of its own, on this "
             "machine")
TAKEN = ("ROS_MASTER_URI=%s is not used: something listens there already, and this command starts "
         "a ROS master of its own")


def named_by_caller() -> str:
    """The URI of the master that the caller has chosen; "" for the usual one."""
    uri = os.environ.get(CALLERS, os.environ.get("ROS_MASTER_URI", "")).rstrip("/")
    return "" if uri == USUAL else uri


def own_port() -> tuple[int, tuple[str, ...]]:
    """A free port for a new master: the caller's, if that is possible, else another.

    Then also why: a format string and its argument.
    """
    uri = named_by_caller()
    if not uri:
        return free_port(), ()
    try:
        place = urlsplit(uri)
        host, port = place.hostname or "", place.port or USUAL_PORT
    except ValueError:  # not a URI
        return free_port(), (ELSEWHERE, uri)
    if not is_local_address(host):
        return free_port(), (ELSEWHERE, uri)
    found = free_port(port)
    return (found, ()) if found == port else (free_port(), (TAKEN, uri))


def master_to_join() -> str:
    """URI of the usual master: a running one of this user, or one to be started; else a free one.

    It is another user's, or another program has its port: then another port is chosen.
    """
    ours = listens_here(USUAL_PORT) and is_up(USUAL)
    return USUAL if ours else f"http://localhost:{free_port()}"


def free_port(wished: int = USUAL_PORT) -> int:
    """This port if it is free, else another."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("", wished))
        except OSError:
            probe.bind(("", 0))
        return probe.getsockname()[1]


def is_up(master_uri: str) -> bool:
    """Whether roscore has set /run_id; if roslaunch starts earlier and sets it, roscore exits."""
    try:
        master = xmlrpc.client.ServerProxy(master_uri, ImpatientTransport())
        code, _, named = master.hasParam("/course_run", "/run_id")
    except (OSError, xmlrpc.client.Error, HTTPException, ExpatError, TypeError, ValueError):
        return False  # nothing, or another program
    return code == 1 and named


def listens_here(port: int) -> bool:
    """Whether a process of this user, on this machine, listens at the port."""
    for one in psutil.net_connections("tcp"):
        if one.status == psutil.CONN_LISTEN and one.laddr.port == port and one.pid:
            with contextlib.suppress(psutil.Error):
                return psutil.Process(one.pid).uids().real == os.getuid()
    return False


if __name__ == "__main__":
    print(master_to_join())
