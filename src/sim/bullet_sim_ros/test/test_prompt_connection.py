"""Messages over a real socket pair: at once where it takes them, in order, never waiting."""

import socket
import threading
import time
import weakref

import numpy as np
import pytest
from rospy.exceptions import TransportTerminated
from rospy.impl.tcpros_base import TCPROSTransport, TCPROSTransportProtocol

from bullet_sim_ros.rospy_patches import PromptConnection

LIMIT = 60.0  # s


class Pair:
    """A TCPROS connection whose other end the test reads."""

    def __init__(self, queue_size):
        with socket.create_server(("127.0.0.1", 0)) as server:
            ours = socket.create_connection(server.getsockname())
            self.subscriber, _ = server.accept()
        self.subscriber.settimeout(LIMIT)
        self.transport = TCPROSTransport(TCPROSTransportProtocol("/x", None), "/x")
        self.transport.set_socket(ours, "/subscriber")
        self.connection = PromptConnection(self.transport, queue_size)

    def read(self, size):
        data = bytearray()
        while len(data) < size:
            piece = self.subscriber.recv(size - len(data))
            assert piece, "closed"
            data += piece
        return bytes(data)


@pytest.fixture
def pair():
    made = Pair(queue_size=2)
    yield made
    made.transport.close()
    made.subscriber.close()


def test_a_small_message_is_sent_by_the_caller_itself(pair):
    threads = threading.active_count()
    assert pair.connection.write_data(b"hello")
    assert pair.read(5) == b"hello"
    assert threading.active_count() == threads
    assert (pair.transport.stat_bytes, pair.transport.stat_num_msg) == (5, 1)


def test_a_subscriber_that_hangs_delays_nobody_and_loses_the_oldest(pair):
    size = 20_000_000  # more than any socket buffer takes
    sent = [bytes([65 + number]) * size for number in range(5)]  # A is begun, B and C will go
    for message in sent:
        pair.connection.write_data(message)
    got = pair.read(3 * size)
    assert [got[number * size:number * size + 1] for number in range(3)] == [b"A", b"D", b"E"]
    assert got == sent[0] + sent[3] + sent[4]


def test_a_small_message_waits_behind_a_large_one(pair):
    pair.connection.write_data(b"L" * 20_000_000)
    pair.connection.write_data(b"s")
    assert pair.read(20_000_001).endswith(b"Ls")


def test_a_message_in_pieces_is_one(pair):
    pieces = [b"head", b"L" * 20_000_000, b"tail"]  # the second is more than any socket takes
    pair.connection.write_data([memoryview(piece) for piece in pieces])
    pair.connection.write_data(b"next")
    assert pair.read(20_000_012) == b"".join(pieces) + b"next"


def test_a_message_that_could_not_be_sent_is_not_kept(pair, no_collector):
    message = np.zeros(20_000_000, np.uint8)
    kept = weakref.ref(message)
    pair.connection.write_data([message.data])
    pair.transport.socket.shutdown(socket.SHUT_WR)
    del message
    until = time.monotonic() + LIMIT
    while kept() is not None and time.monotonic() < until:
        time.sleep(0.01)
    assert kept() is None


def test_a_closed_subscriber_is_told_to_rospy(pair):
    pair.subscriber.close()
    with pytest.raises(TransportTerminated):
        for _ in range(100):
            pair.connection.write_data(b"x" * 1000)
    assert pair.transport.done


def test_closing_waits_for_no_lock_that_another_thread_may_need(pair):
    """rospy closes connections under the topic's lock, and asks for that lock when one closes."""
    topic_lock, entered = threading.Lock(), threading.Event()

    def removed_from_topic(_transport):
        entered.set()
        assert topic_lock.acquire(timeout=LIMIT)
        topic_lock.release()

    pair.transport.set_cleanup_callback(removed_from_topic)
    pair.subscriber.close()

    def publish():
        try:
            for _ in range(100):
                pair.connection.write_data(b"x" * 1000)
        except TransportTerminated:
            pass

    with topic_lock:
        publisher = threading.Thread(target=publish)
        publisher.start()
        assert entered.wait(LIMIT)
        assert pair.connection._changed.acquire(timeout=LIMIT)  # as another closer needs it
        pair.connection._changed.release()
    publisher.join(LIMIT)
    assert not publisher.is_alive()
