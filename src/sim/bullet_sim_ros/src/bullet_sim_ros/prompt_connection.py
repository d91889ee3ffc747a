"""Sends messages at once if the socket takes them; a subscriber that hangs still delays nobody.

rospy passes every message to a thread of the connection. At a simulator's rates these switches
between threads cost more than the rest of publishing: 0.25 ms for each small message (measured), a
third of the time for a frame when time runs four times as fast as usual.
"""

import socket
import threading
from collections import deque

from rospy.exceptions import TransportTerminated
from rospy.impl.transport import Transport


class PromptConnection:
    """Replaces rospy's QueuedConnection: messages that the socket does not take wait in a queue."""

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
