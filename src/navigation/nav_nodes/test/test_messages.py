"""Maps and quaternions as messages: the quick way of packing a map gives the usual bytes."""

import math
import time
from io import BytesIO

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import GetMapResponse, LoadMapResponse

from nav_algorithms.cells import OccupancyGrid
from nav_nodes.messages import (
    LoadedMapAnswer,
    MapAnswer,
    grid_message,
    grid_of,
    is_valid,
    quaternion_of,
    yaw_of,
)

GRID = OccupancyGrid(np.random.default_rng(0).integers(-1, 101, (7, 5)).astype(np.int8), 0.25,
                     (-1.5, 2.0))


def packed(message):
    buffer = BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def test_a_map_packs_as_any_other_message():
    quick = grid_message(GRID, "map", rospy.Time(3, 4))
    usual = OccupancyGridMessage(quick.header, quick.info, GRID.cells.ravel().tolist())
    assert packed(quick) == packed(usual)
    assert isinstance(quick, OccupancyGridMessage)
    assert quick._md5sum == usual._md5sum


@pytest.mark.parametrize("quick, usual, more", [
    (MapAnswer, GetMapResponse, ()), (LoadedMapAnswer, LoadMapResponse, (255,))])
def test_an_answer_with_a_map_packs_as_any_other(quick, usual, more):
    message = grid_message(GRID, "map", rospy.Time(3, 4))
    listed = OccupancyGridMessage(message.header, message.info, GRID.cells.ravel().tolist())
    assert packed(quick(message, *more)) == packed(usual(listed, *more))
    assert quick._type == usual._type  # by which rospy knows an answer


def test_a_large_map_is_answered_at_once():
    """The usual way takes 2 s for a map of gmapping's default size, and no thread goes on."""
    message = grid_message(OccupancyGrid(np.zeros((2000, 2000), np.int8), 0.05, (0.0, 0.0)),
                           "map", rospy.Time(3, 4))
    begun = time.process_time()
    packed(MapAnswer(message))
    assert time.process_time() - begun < 0.2


def test_there_and_back():
    received = OccupancyGridMessage()
    received.deserialize(packed(grid_message(GRID, "map", rospy.Time(3, 4))))
    grid = grid_of(received)
    assert np.array_equal(grid.cells, GRID.cells)
    assert (grid.resolution, grid.origin) == (GRID.resolution, GRID.origin)
    assert (received.header.frame_id, received.info.map_load_time) == ("map", rospy.Time(3, 4))


HUGE = 1e308  # its square is beyond float64


@pytest.mark.parametrize("yaw", [0.0, 1.0, -3.0])
@pytest.mark.parametrize("length", [1.0, 1e-3, 1e3])
def test_a_turn_about_z_of_any_length(yaw, length):
    q = quaternion_of(yaw)
    q.z, q.w = q.z * length, q.w * length
    assert is_valid(q) and yaw_of(q) == pytest.approx(yaw)


@pytest.mark.parametrize("q", [
    (0, 0, 0, 0), (math.nan, 0, 0, 1), (0, 0, math.inf, 1), (1, 0, 0, 1), (0, 0, HUGE, HUGE)])
def test_what_is_no_turn_about_z_is_no_error(q):
    assert not is_valid(Quaternion(*q))
    yaw_of(Quaternion(*q))
