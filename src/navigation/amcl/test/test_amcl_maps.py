"""Which maps count as having come; no master."""

import threading
from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from nav_msgs.msg import OccupancyGrid as Map
from nav_msgs.srv import SetMapRequest

from amcl import maps
from amcl.maps import MapSource, grid_in
from amcl.node import AmclNode
from nav_algorithms.cells import OccupancyGrid
from nav_nodes.messages import grid_message

GOOD = grid_message(OccupancyGrid(np.zeros((2, 3), np.int8), 0.05, (0.0, 0.0)), "map",
                    rospy.Time(1))


@pytest.fixture
def source(monkeypatch):
    """`taken` has the maps that it gave on, `lines` what was said, last of all what is missing."""
    lines, taken = [], []
    missing_data = SimpleNamespace(missing=lambda *words: lines.append(words),
                                   present=lambda what: lines.append(f"{what} is there"))
    found = MapSource(lambda message: taken.append(grid_in(message, "map")), missing_data)
    found.lines, found.taken = lines, taken
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: SimpleNamespace(resolved_name="/map"))
    monkeypatch.setattr(rospy, "logerr_throttle", lambda seconds, text, *values:
                        lines.append((seconds, text % values)))
    return found


def missed(source):
    source.complain()
    return source.lines[-1]


def test_a_map_that_is_none_is_no_first_map(source):
    source.follow(topic=True, first_only=True)
    assert missed(source) == ("map on /map", "start map_server with the map's YAML file")
    source._from_topic(Map())
    assert missed(source) == ("map on /map", "the one that came is of no use: a map of 0 x 0 cells "
                                             "came with 0")
    source._from_topic(GOOD)
    assert missed(source) == "map on /map is there" and len(source.taken) == 1
    source._from_topic(GOOD)
    assert len(source.taken) == 1


def test_a_later_map_that_is_none_leaves_the_first_and_is_said(source):
    source.follow(topic=True, first_only=False)
    source._from_topic(GOOD)
    source._from_topic(Map())
    assert source.lines == [(5.0, "a map came that is of no use, passed over: a map of 0 x 0 cells "
                                  "came with 0")]
    assert missed(source) == "map on /map is there" and len(source.taken) == 1


def test_the_service_is_asked_until_a_map_came(source, monkeypatch):
    answers = iter([Map(), rospy.ServiceException("not now"), GOOD])

    def call():
        answer = next(answers)
        if isinstance(answer, Exception):
            raise answer
        return SimpleNamespace(map=answer)

    monkeypatch.setattr(rospy, "ServiceProxy", lambda *_: call)
    monkeypatch.setattr(rospy, "is_shutdown", lambda: False)
    monkeypatch.setattr(maps, "RETRY", 0.0)
    source._ask()
    assert len(source.taken) == 1 and next(answers, None) is None


def test_a_map_that_was_set_is_not_replaced_by_the_answer_that_comes_meanwhile(source):
    at_work, go_on = threading.Event(), threading.Event()

    def take(message):
        source.taken.append(message)
        at_work.set()
        go_on.wait(60.0)

    source._take = take
    setting = threading.Thread(target=source.set, args=(GOOD,))
    asking = threading.Thread(target=source.set, args=(Map(), True))
    setting.start()
    assert at_work.wait(60.0)
    asking.start()
    asking.join(0.1)  # s; it has to wait
    go_on.set()
    for thread in (setting, asking):
        thread.join(60.0)
    assert source.taken == [GOOD]


@pytest.mark.parametrize("message, success", [(Map(), False), (GOOD, True)])
def test_set_map_answers_whether_the_map_was_taken(source, message, success):
    node = AmclNode.__new__(AmclNode)
    node._maps, node._lock, poses = source, threading.RLock(), []
    node._take_pose = poses.append
    node._values, node._localisation = {"force_update_after_set_map": False}, None
    assert node._set_map(SetMapRequest(map=message)).success is success
    assert len(poses) == len(source.taken) == int(success)
