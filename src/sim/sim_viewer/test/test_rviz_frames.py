"""The bytes of a frame, how many points a page is sent, and which messages wait."""

import json
import struct

import numpy as np
import pytest
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.drawing import Part, encode, frame, points_of
from sim_viewer.rviz.showing import FEWEST, MOST, QUEUE, Pace, Waiting

from bullet_sim.pose import Pose


def decoded(data):
    """Parts with arrays, as web/rviz/frame.js reads them."""
    number, length = struct.unpack_from("<II", data)
    parts = json.loads(data[8:8 + length])
    for part in parts:
        for name, (kind, at, count) in part.get("arrays", {}).items():
            assert (8 + length + at) % 4 == 0
            part["arrays"][name] = np.frombuffer(data, f"<{kind}", count, 8 + length + at)
    return number, parts


def test_arrays_come_back_as_they_were():
    part = Part("points", {"colour": np.arange(5, dtype=np.uint8),
                           "position": np.arange(6.0).reshape(2, 3).astype(np.float32)},
                {"size": 0.5, "name": "盒"}, Pose((1.0, 2.0, 3.0)))
    number, (read,) = decoded(frame(7, encode([part])))
    assert (number, read["kind"], read["size"], read["name"]) == (7, "points", 0.5, "盒")
    assert read["pose"] == [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]
    assert read["arrays"]["colour"].tolist() == [0, 1, 2, 3, 4]
    assert read["arrays"]["position"].tolist() == [0, 1, 2, 3, 4, 5]


def test_what_the_page_has_comes_without_arrays():
    part = Part("map", {"cells": np.zeros(9, np.uint8)}, key="a")
    assert "arrays" in decoded(frame(1, encode([part], {"b"})))[1][0]
    assert "arrays" not in decoded(frame(1, encode([part], {"a"})))[1][0]
    assert decoded(frame(1, encode([])))[1] == []


def test_points_are_counted_by_their_colours():
    assert points_of([Part("points", {"colour": np.zeros((3, 4), np.uint8)}), Part("texts")]) == 3


def test_a_page_gets_one_frame_at_a_time_and_fewer_points_when_it_is_slow():
    pace = Pace()
    assert pace.free and pace.most_points == MOST
    number = pace.sent(MOST, 0.0)
    assert not pace.free and not pace.drawn(number + 1, 0.1)
    assert pace.drawn(number, 2.0) and pace.free and pace.most_points == MOST // 2
    for _ in range(20):
        pace.drawn(pace.sent(pace.most_points, 0.0), 5.0)
    assert pace.most_points == FEWEST
    for _ in range(30):
        pace.drawn(pace.sent(pace.most_points, 0.0), 0.1)
    assert pace.most_points == MOST


def test_a_slow_picture_of_few_points_does_not_count():
    pace = Pace()
    pace.drawn(pace.sent(100, 0.0), 5.0)
    assert pace.most_points == MOST


class Raw:
    def __init__(self, number):
        self.number, self._buff = number, b"x"


def waiting(every=False, read=lambda raw: (raw.number, "/node"), count=20):
    queue = Waiting(every, read)
    for number in range(count):
        queue.put(Raw(number))
    return queue


def test_the_newest_that_is_ready_is_shown_and_older_ones_are_dropped():
    def up_to(last):
        def ready(received):
            if received[0] > last:
                raise Problem(str(received[0]))
            return "pose"
        return ready

    queue = waiting()
    assert queue.received == 20
    raw, received, pose = queue.newest(up_to(17))
    assert (raw.number, received, pose) == (17, (17, "/node"), "pose")
    with pytest.raises(Problem, match="19"):
        queue.newest(up_to(17))
    assert queue.newest(up_to(99))[0].number == 19
    assert queue.newest(up_to(99)) is None


def test_only_so_many_wait_and_where_each_counts_all_do():
    assert len(waiting().in_order()) == QUEUE
    assert [raw.number for raw in waiting(every=True).in_order()] == list(range(20))


def test_one_that_cannot_be_read_is_told_of_once():
    def read(raw):
        raise Problem("broken")

    queue = waiting(read=read)
    with pytest.raises(Problem, match="broken"):
        queue.newest(lambda received: None)
    assert queue.newest(lambda received: None) is None
