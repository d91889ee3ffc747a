"""Maps as messages: the quick way of packing them gives the usual bytes."""

from io import BytesIO

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage

from nav_algorithms.grid import OccupancyGrid
from nav_nodes.messages import grid_message, grid_of

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


def test_there_and_back():
    received = OccupancyGridMessage()
    received.deserialize(packed(grid_message(GRID, "map", rospy.Time(3, 4))))
    grid = grid_of(received)
    assert np.array_equal(grid.cells, GRID.cells)
    assert (grid.resolution, grid.origin) == (GRID.resolution, GRID.origin)
    assert (received.header.frame_id, received.info.map_load_time) == ("map", rospy.Time(3, 4))
