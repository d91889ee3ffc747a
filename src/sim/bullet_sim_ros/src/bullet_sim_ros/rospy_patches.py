"""The changes to rospy that our programs make, each with its reason."""

import socket
import threading
from collections import deque
from collections.abc import Callable
from io import BytesIO

import numpy as np
import rospy.topics
from rospy import core, rostime
from rospy.exceptions import TransportTerminated
from rospy.impl.masterslave import ROSHandler
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_service import ServiceImpl
from rospy.impl.transport import Transport

REFUSED = "refused: this node obeys the course alone"


def send_promptly() -> None:
    """Make all publishers of this process, which need a queue, send at once (PromptConnection).

    Before the first is made. rospy passes each message to a thread, which costs more than all else
    of publishing.
    """
    rospy.topics.QueuedConnection = PromptConnection
    rospy.topics.BytesIO = MessageBuffer


def keep_every_publisher() -> None:
    """Make subscribers connect to all publishers, in whatever order they learn of them.

    The master answers a subscription with the publishers of that moment, and reports later ones by
    a call. rospy takes the list that it has read last for the newest: if it reads the answer after
    the call, it never connects to the call's publisher. So one wheel of a car stood still whose
    controllers had started at the same moment as the node that drives it.
    """
    RegManager.publisher_update = _add_update


def _add_update(manager: RegManager, topic: str, uris: list[str]) -> None:
    """Replaces rospy's: merges the waiting lists. Publishers that have ended refuse connections."""
    with manager.cond:
        waiting = [uri for name, known in manager.updates if name == topic for uri in known]
        manager.updates.append((topic, list(dict.fromkeys([*waiting, *uris]))))
        manager.cond.notify_all()


def admit_subscribers(kinds: str, admit: Callable[[str, Callable[[bool], None]], None]) -> None:
    """Let `admit(node, connect)`, in a thread of its own, connect each new subscriber of a topic
    whose type begins with `kinds`; `connect(latched)`: with its latched message, or without.
    """
    add = rospy.topics._PublisherImpl.add_connection

    def add_connection(topic, connection):
        def connect(latched):
            if topic.closed:
                return
            if not latched:
                topic.latch = None
            add(topic, connection)

        if not topic.type.startswith(kinds):
            return add(topic, connection)
        threading.Thread(target=admit, args=(connection.endpoint_id, connect), daemon=True).start()
        return True

    rospy.topics._PublisherImpl.add_connection = add_connection


def set_time(now: rospy.Time) -> None:
    """Set the time of rospy.Time.now, which stamps log messages, in the node that makes /clock.

    That node does not subscribe to /clock; so none of its threads may sleep by this time.
    """
    rostime._rostime_current = now


def report_shutdown() -> None:
    """Make rospy.is_shutdown true, when rospy itself waits for a master that does not answer."""
    core._shutdown_flag = True


def ask_before_obeying(allows: Callable[[str, str, str], bool]) -> None:
    """Ask `allows(kind, name, uri)` before this process's node does what others tell it to; to be
    called before init_node.

    rospy obeys whoever finds its port, whatever the master knows. Kinds: "publisher" (to connect
    to topic `name` at the XML-RPC address `uri`), "service" (to answer a request), "parameter" (to
    take a new value), "shutdown". Only connections and calls are asked about, never a message.
    """
    connect, answer = ROSHandler._connect_topic, ServiceImpl._handle_request
    take, end = ROSHandler.paramUpdate, ROSHandler.shutdown

    def connect_topic(handler, topic, uri):
        return connect(handler, topic, uri) if allows("publisher", topic, uri) else (
            0, REFUSED, 0)

    def handle_request(service, transport, request):
        if allows("service", service.resolved_name, ""):
            answer(service, transport, request)
        else:
            service._write_service_error(transport, REFUSED)

    def param_update(handler, *call):
        name = str(call[1]) if len(call) > 1 else ""
        return take(handler, *call) if allows("parameter", name, "") else (0, REFUSED, 0)

    def shutdown(handler, *call):
        return end(handler, *call) if allows("shutdown", "", "") else (0, REFUSED, 0)

    ROSHandler._connect_topic, ServiceImpl._handle_request = connect_topic, handle_request
    ROSHandler.paramUpdate, ROSHandler.shutdown = param_update, shutdown


class PromptConnection:
    """Replaces rospy's QueuedConnection: messages that the socket does not take wait in a queue.

    A message is sent at once if the socket takes it; a subscriber that hangs still delays nobody.
    rospy passes every message to a thread of the connection. At a simulator's rates these switches
    between threads cost more than the rest of publishing: 0.25 ms for each small message
    (measured), a third of the time for a frame when time runs four times as fast as usual.
    """

    def __init__(self, connection: Transport, queue_size: int):
        """The queue has `queue_size` messages, 0: no limit; when full, it drops the oldest one."""
        self._connection = connection
        self._queue_size = queue_size
        self._changed = threading.Condition()
        self._queue: deque[list[memoryview]] = deque()  # of messages, in pieces
        self._sending: list[memoryview] | None = None  # sent in part, so it must be completed
        self._error: Exception | None = None
        self._thread: threading.Thread | None = None
        connection.set_cleanup_callback(self._closed)
        connection.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def __getattr__(self, name: str):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._connection, name)

    def write_data(self, data: bytes | list[memoryview]) -> bool:
        """Send a message, or queue it; TransportTerminated if the connection has failed before."""
        try:
            with self._changed:
                self._take(data if isinstance(data, list) else [memoryview(data)])
        except OSError as error:
            # Not under our lock: closing takes rospy's lock of the topic, and a thread that holds
            # that one to close a connection waits for ours.
            self._connection.close()
            raise TransportTerminated(str(error)) from error
        return True

    def _take(self, data: list[memoryview]) -> None:
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        if self._sending is None and not self._queue:
            data = self._send(data)
            if not data:
                return
            self._sending = data
        else:
            if 0 < self._queue_size == len(self._queue):
                self._queue.popleft()
            self._queue.append(data)
        self._start_thread()
        self._changed.notify()

    def _send(self, data: list[memoryview]) -> list[memoryview]:
        """Give the socket as much as it takes without waiting; returns the rest."""
        connection = self._connection
        if connection.done or not connection.socket:
            raise TransportTerminated("connection closed")
        try:
            sent = connection.socket.sendmsg(data, [], socket.MSG_DONTWAIT)
        except BlockingIOError:
            sent = 0
        connection.stat_bytes += sent
        rest = _without(data, sent)
        connection.stat_num_msg += not rest
        return rest

    def _start_thread(self) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=self._work_off, daemon=True)
            self._thread.start()

    def _work_off(self) -> None:
        """In the connection's thread: send the queue, however long the subscriber takes."""
        while not self._connection.done:
            with self._changed:
                while self._sending is None and not self._queue and not self._connection.done:
                    self._changed.wait()
                if self._sending is None and self._queue:
                    self._sending = self._queue.popleft()
                data = self._sending
            if data is None:
                return
            try:
                for piece in data:
                    self._connection.write_data(piece)
                self._connection.stat_num_msg -= len(data) - 1  # it was one message
                error = None
            except Exception as failure:  # raised when the next message is published
                error = failure.with_traceback(None)  # which would keep the message in memory
                error.__context__ = None
            data = piece = None  # else the message stays in memory until the next one
            with self._changed:
                self._sending, self._error = None, error

    def _closed(self, _connection: Transport) -> None:
        with self._changed:
            self._changed.notify()


def _without(pieces: list[memoryview], size: int) -> list[memoryview]:
    """The pieces without their first `size` bytes."""
    rest = []
    for piece in pieces:
        if size < piece.nbytes:
            rest.append(piece[size:])
        size = max(size - piece.nbytes, 0)
    return rest


class MessageBuffer(BytesIO):
    """Replaces rospy's BytesIO: large arrays are sent without a copy. Positions include them."""

    def __init__(self):
        super().__init__()
        self._arrays: list[tuple[int, int, memoryview]] = []  # start, bytes of our own before it

    def append(self, array: np.ndarray) -> None:
        """Append a C-contiguous array, which must not change any more."""
        own = super().tell()
        self._arrays.append((self.tell(), own, array.reshape(-1).view(np.uint8).data))

    def tell(self) -> int:
        """The number of bytes before the position."""
        place = super().tell()
        return place + sum(array.nbytes for _, own, array in self._arrays if own <= place)

    def seek(self, position: int) -> int:
        """Go to a position in bytes from the start, which is not inside an array."""
        super().seek(position - sum(
            array.nbytes for start, _, array in self._arrays if start < position))
        return position

    def truncate(self, size: int) -> int:
        """Drop everything after `size` bytes, and all arrays."""
        self._arrays.clear()
        return super().truncate(size)

    def getvalue(self) -> bytes | list[memoryview]:
        """The message, in pieces if it has arrays."""
        if not self._arrays:
            return super().getvalue()
        written, pieces, begin = memoryview(super().getvalue()), [], 0
        for _, own, array in self._arrays:
            pieces += [written[begin:own], array]
            begin = own
        return [piece for piece in [*pieces, written[begin:]] if piece]


def write_array(buff: BytesIO, array: np.ndarray) -> None:
    """Write an array into a message; it is copied only if `buff` is not a MessageBuffer."""
    if isinstance(buff, MessageBuffer):
        buff.append(array)
    else:
        buff.write(array.data)
