"""Queries the machine, the master and the nodes, each within TIMEOUT."""

from __future__ import annotations

import http.client
import socket
import threading
import time
import xmlrpc.client
from contextlib import contextmanager
from email.utils import parsedate_to_datetime
from xmlrpc.server import SimpleXMLRPCServer

from nav_demo.network.answers import Node
from nav_demo.network.settings import Surroundings, split_uri

TIMEOUT = 2.0  # s
CALLER = "/check_network"


def addresses_of(name: str) -> list[str]:
    """IPv4 addresses of a host, each once; empty if it is unknown."""
    try:
        found = socket.getaddrinfo(name, None, socket.AF_INET, socket.SOCK_STREAM)
    except (OSError, UnicodeError):
        return []
    return list(dict.fromkeys(entry[4][0] for entry in found))  # /etc/hosts may list one twice


def is_mine(address: str) -> bool:
    """Whether the address is this machine's: only those can be bound."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind((address, 0))
        except OSError:
            return False
    return True


def address_towards(address: str) -> str:
    """This machine's address on the route to another one; sends nothing."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((address, 9))
        except OSError:
            return "127.0.0.1"
        return probe.getsockname()[0]


def surroundings() -> Surroundings:
    """The Surroundings of this machine."""
    return Surroundings(addresses_of, is_mine, address_towards, socket.gethostname())


class _Transport(xmlrpc.client.Transport):
    """A transport with TIMEOUT that keeps the last response's Date header."""

    date: str | None = None

    def make_connection(self, host: str) -> http.client.HTTPConnection:
        return http.client.HTTPConnection(host, timeout=TIMEOUT)

    def parse_response(self, response: http.client.HTTPResponse) -> tuple:
        self.date = response.getheader("Date")
        return super().parse_response(response)


class Peer:
    """A master or a node, by its URI."""

    def __init__(self, uri: str) -> None:
        self._transport = _Transport()
        self._calls = xmlrpc.client.ServerProxy(uri, transport=self._transport)

    def call(self, method: str, *arguments: object) -> object:
        """The value of an answer, or None if the call was refused. Raises OSError and others."""
        code, _, value = getattr(self._calls, method)(CALLER, *arguments)
        return value if code == 1 else None

    def answer(self) -> str:
        """One of yes, refused (no listener), silence, other (it answers, but not as ROS does)."""
        try:
            self.call("getPid")
        except ConnectionRefusedError:
            return "refused"
        except OSError:
            return "silence"
        except (xmlrpc.client.Error, http.client.HTTPException, ValueError, TypeError):
            return "other"
        return "yes"

    def clock_ahead(self) -> float | None:
        """Its clock minus this one's, s, from the last response's date; resolution 1 s."""
        if not self._transport.date:
            return None
        return parsedate_to_datetime(self._transport.date).timestamp() + 0.5 - time.time()

    def calls_ms(self, count: int = 7) -> list[float]:
        """How long `count` calls take, ms."""
        durations = []
        for _ in range(count):
            start = time.perf_counter()
            self.call("getPid")
            durations.append((time.perf_counter() - start) * 1e3)
        return durations


def registered_nodes(master: Peer) -> list[Node]:
    """All nodes registered with the master, each checked for an answer."""
    state = master.call("getSystemState")
    names = sorted({name for kind in state for _, users in kind for name in users})
    uris = {name: master.call("lookupNode", name) for name in names}
    nodes: list[Node | None] = [None] * len(names)

    def ask(index: int, name: str, uri: str) -> None:
        place = split_uri(uri)
        known = addresses_of(place[0]) if place else []
        nodes[index] = Node(name, uri, known[0] if known else "",
                            Peer(uri).answer() if known else "silence")

    threads = [threading.Thread(target=ask, args=(index, name, uris[name]), daemon=True)
               for index, name in enumerate(names) if uris[name]]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(3 * TIMEOUT)
    return [node for node in nodes if node is not None]


def has_publisher(master: Peer, topic: str) -> bool:
    """Whether the topic has a publisher."""
    return any(name == topic and users for name, users in master.call("getSystemState")[0])


@contextmanager
def _listening(came: threading.Event):
    """A server in this process that only handles publisherUpdate; yields its port."""
    server = SimpleXMLRPCServer(("0.0.0.0", 0), logRequests=False)
    server.register_function(lambda *_: (came.set(), (1, "", 0))[1], "publisherUpdate")
    thread = threading.Thread(target=server.serve_forever, args=(0.1,), daemon=True)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        server.server_close()


def master_calls_back(master: Peer, name: str) -> bool:
    """Registers a subscriber under `name`, and a publisher, so that the master calls the former."""
    came, topic = threading.Event(), f"{CALLER}/{time.monotonic_ns()}"
    with _listening(came) as port:
        uri = f"http://{name}:{port}/"
        master.call("registerSubscriber", topic, "std_msgs/Empty", uri)
        master.call("registerPublisher", topic, "std_msgs/Empty", uri)
        try:
            return came.wait(TIMEOUT)
        finally:
            master.call("unregisterPublisher", topic, uri)
            master.call("unregisterSubscriber", topic, uri)
