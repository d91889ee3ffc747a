"""ROS masters: which one a command uses, whether it is up, and who is connected to whom.

As a program, for scripts/common.sh: prints the URI of a master that other terminals can join; with
`--wait PID`, waits for the simulator of a process.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import socket
import sys
import time
import xmlrpc.client
from collections.abc import Iterable
from dataclasses import dataclass
from http.client import HTTPException
from pathlib import Path
from typing import IO
from urllib.parse import urlsplit
from xml.parsers.expat import ExpatError

import psutil
import rosgraph
from rosgraph.network import is_local_address

from bullet_sim_ros.already_running import ImpatientTransport
from run_session.failure import RunError

ANSWER_TIME = 1.0  # s, wall, for one answer of a node
SIMULATORS = "/gazebo/get_world_properties"  # the service by which a simulator is known
POLL_PERIOD = 0.2  # s, wall


@dataclass(frozen=True)
class Connections:
    """Node names by topic, and the publishers' open links: (publisher, topic, subscriber).

    The master knows which nodes should be connected; only the publisher knows which are.
    """

    publishers: dict[str, frozenset[str]]
    subscribers: dict[str, frozenset[str]]
    links: frozenset[tuple[str, str, str]]

    def missing_link(self, topic: str) -> str | None:
        """The first connection of this topic that is not open yet, in words; None if all are."""
        for publisher in sorted(self.publishers[topic]):
            for subscriber in sorted(self.subscribers[topic] - {publisher}):
                if (publisher, topic, subscriber) not in self.links:
                    return f"the connection of {topic} from {publisher} to {subscriber}"
        return None


def look_up(master_uri: str, caller: str, topics: Iterable[str]) -> Connections:
    """Query the master and each publisher of these topics; one that does not answer has no links.

    Raises OSError, xmlrpc.client.Error or rosgraph.MasterException if the master fails.
    """
    master = rosgraph.Master(caller, master_uri)
    publishing, subscribing, _ = master.getSystemState()
    publishers = {topic: frozenset(nodes) for topic, nodes in publishing}
    subscribers = {topic: frozenset(nodes) for topic, nodes in subscribing}
    nobody: frozenset[str] = frozenset()
    wanted = {topic: publishers.get(topic, nobody) for topic in topics}
    nodes = nobody.union(*wanted.values())
    return Connections(
        wanted,
        {topic: subscribers.get(topic, nobody) for topic in wanted},
        frozenset(link for node in nodes for link in _links_of(master, caller, node)),
    )


def _links_of(master: rosgraph.Master, caller: str, node: str) -> list[tuple[str, str, str]]:
    """A node's outgoing connections, from its getBusInfo (ROS slave API)."""
    try:
        slave = xmlrpc.client.ServerProxy(master.lookupNode(node), ImpatientTransport(ANSWER_TIME))
        _, _, connections = slave.getBusInfo(caller)
        return [
            (node, str(topic), str(receiver))
            for _, receiver, direction, _, topic, is_open, *_ in connections
            if direction == "o" and is_open
        ]
    except (OSError, xmlrpc.client.Error, HTTPException, ExpatError, rosgraph.MasterException,
            AttributeError, LookupError, TypeError, ValueError):
        return []  # it hangs, is gone, or its answer is malformed


TURN_LIMIT = 300.0  # s, wall; as long as a roscore may take
TURN_PERIOD = 0.05  # s, wall, between two attempts


def take_turn(path: Path, limit: float = TURN_LIMIT) -> IO:
    """Lock the file and return it: closing it releases the lock. It has the holder's number.

    RunError if it is not released within `limit`, s, wall, or if it is another user's.
    """
    try:
        number = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}: name a folder of your own for temporary files,"
                       " such as: export TMPDIR=~/tmp") from error
    file = os.fdopen(number, "r+b")
    until, told = time.monotonic() + limit, False
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            file.seek(0)  # _waiting has read on
            file.truncate()
            file.write(b"%d\n" % os.getpid())
            file.flush()
            return file
        except BlockingIOError:
            if not told:
                told = True
                print(_waiting(file), file=sys.stderr, flush=True)
            if time.monotonic() > until:
                file.close()
                raise RunError(f"{path} is held by another run that starts its roscore for more"
                               f" than {limit:.0f} s: end it, then run this again") from None
            time.sleep(TURN_PERIOD)


def _waiting(file: IO) -> str:
    """Whose turn it is, and since when (take_turn in scripts/common.sh says the same)."""
    number, name = file.read(20).decode(errors="replace").strip() or "?", "?"
    with contextlib.suppress(psutil.Error, ValueError, IndexError):  # it has just ended
        name = Path(psutil.Process(int(number)).cmdline()[1]).name
    age = max(0, int(time.time() - os.fstat(file.fileno()).st_mtime))
    return f"Waiting: {name} (process {number}) has been starting its simulator for {age} s"


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


def own_port(joined: bool = False) -> tuple[int, tuple[str, ...]]:
    """A free port for a new master: the caller's, if that is possible, else another.

    Then also why: a format string and its argument. Only a run that other terminals join
    (`joined`) takes the usual port: to any other's master a terminal that is open beside it would
    connect by accident, and disturb the run.
    """
    uri, usual = named_by_caller(), USUAL_PORT if joined else 0
    if not uri:
        return free_port(usual), ()
    try:
        place = urlsplit(uri)
        host, port = place.hostname or "", place.port or USUAL_PORT
    except ValueError:  # not a URI
        return free_port(usual), (ELSEWHERE, uri)
    if not is_local_address(host):
        return free_port(usual), (ELSEWHERE, uri)
    found = free_port(port)
    return (found, ()) if found == port else (free_port(usual), (TAKEN, uri))


def master_to_join() -> str:
    """URI of the usual master: a running one of this user, or one to be started; else a free one.

    It is another user's, or another program has its port: then another port is chosen.
    """
    ours = listens_here(USUAL_PORT) and is_up(USUAL)
    return USUAL if ours else f"http://localhost:{free_port()}"


def free_port(wished: int = USUAL_PORT) -> int:
    """This port if it is free, else another; 0: any."""
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
        master = xmlrpc.client.ServerProxy(master_uri, ImpatientTransport(ANSWER_TIME))
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


def wait_for_simulator(process: int) -> bool:
    """Wait until this master has a simulator; False if the process with this number ends before."""
    master = xmlrpc.client.ServerProxy(rosgraph.get_master_uri(), ImpatientTransport(ANSWER_TIME))
    while not _has_simulator(master):
        try:
            if psutil.Process(process).status() == psutil.STATUS_ZOMBIE:
                return False
        except psutil.NoSuchProcess:
            return False
        time.sleep(POLL_PERIOD)
    return True


def _has_simulator(master: xmlrpc.client.ServerProxy) -> bool:
    try:
        code, _, _ = master.lookupService("/course_run", SIMULATORS)
    except (OSError, xmlrpc.client.Error, HTTPException, ExpatError, TypeError, ValueError):
        return False  # there is no master yet
    return code == 1


if __name__ == "__main__":
    if sys.argv[1:2] == ["--wait"]:
        sys.exit(not wait_for_simulator(int(sys.argv[2])))
    print(master_to_join())
