"""SHA-256 over every byte that the robot's sensors sent, to compare runs."""

from __future__ import annotations

import hashlib
import struct
import threading
import time
from collections.abc import Iterable

import rospy

LAST_MESSAGE_TIME = 1.0  # s, wall, to wait for messages still in transit
SEQ_AND_STAMP = struct.Struct("<III")  # how a serialised std_msgs/Header begins


class Fingerprints:
    """Takes the raw messages of all sensor topics; each begins with a header.

    rospy allows one message type per topic and node: nothing else here may subscribe to these.
    """

    def __init__(self, topics: Iterable[str]):
        self._topics = topics
        self._lock = threading.Lock()
        self._rows: dict[str, list[tuple[int, float, bytes]]] = {}  # seq, stamp in s, SHA-256

    def start(self) -> None:
        """Subscribe."""
        for topic in self._topics:
            rows = self._rows[topic] = []
            rospy.Subscriber(topic, rospy.AnyMsg, self._take, callback_args=rows, queue_size=None,
                             buff_size=2**22, tcp_nodelay=True)

    def _take(self, message: rospy.AnyMsg, rows: list) -> None:
        seq, secs, nsecs = SEQ_AND_STAMP.unpack_from(message._buff)
        row = seq, secs + 1e-9 * nsecs, hashlib.sha256(message._buff).digest()
        with self._lock:
            rows.append(row)

    def sums(self, until: float) -> dict[str, str | None]:
        """For each topic the checksum of its messages up to this simulated time (s).

        None if a message was missed: then the checksum would be meaningless.
        """
        give_up = time.monotonic() + LAST_MESSAGE_TIME
        while not self._later_than(until) and time.monotonic() < give_up:
            time.sleep(0.01)
        with self._lock:
            return {topic: _sum(rows, until) for topic, rows in self._rows.items()}

    def _later_than(self, time_s: float) -> bool:
        with self._lock:
            return all(rows and rows[-1][1] > time_s for rows in self._rows.values())


def _sum(rows: list[tuple[int, float, bytes]], until: float) -> str | None:
    counted = [row for row in rows if row[1] <= until]
    if not counted or counted[-1][0] - counted[0][0] != len(counted) - 1:
        return None
    return hashlib.sha256(b"".join(digest for _, _, digest in counted)).hexdigest()
