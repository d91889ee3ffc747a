"""The node map_server: serves a map from a file, by topics and services."""

from __future__ import annotations

import threading
from pathlib import Path

import rospkg
import rospy
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import (
    GetMap,
    GetMapRequest,
    GetMapResponse,
    LoadMap,
    LoadMapRequest,
    LoadMapResponse,
)

from map_server.errors import MapFileError, MapImageError, MapMetadataError, MapMissingError
from map_server.map_files import load_map, read_map
from map_server.metadata import COARSEST, FINEST, MapMetadata
from nav_nodes.ignored import warn_of_ignored
from nav_nodes.messages import LoadedMapAnswer, MapAnswer, grid_message, quaternion_of
from nav_nodes.missing_data import MissingData, wait_for_clock
from nav_nodes.parameters import ParameterError, load_table, read_parameters
from nav_nodes.program import init_node, spin

USAGE = ("usage: map_server MAP.yaml (or, deprecated: map_server IMAGE RESOLUTION, with "
         f"{FINEST:g} to {COARSEST:g} m a pixel)")
FAILED = 255  # upstream's exit(-1)
RESULTS = {MapMissingError: LoadMapResponse.RESULT_MAP_DOES_NOT_EXIST,
           MapMetadataError: LoadMapResponse.RESULT_INVALID_MAP_METADATA,
           MapImageError: LoadMapResponse.RESULT_INVALID_MAP_DATA}


class MapServer:
    """Publishes one map, latched, until it is replaced.

    change_map's result tells what was wrong; upstream answers 255 to every error.
    """

    def __init__(self, loaded: tuple, frame: str) -> None:
        """`loaded` is read_map's result; rospy is initialised and its clock runs."""
        self._frame = frame
        self._lock = threading.Lock()
        self._map_topic = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        self._metadata_topic = rospy.Publisher("map_metadata", MapMetaData, queue_size=1,
                                               latch=True)
        self._map = self._show(loaded)
        rospy.Service("static_map", GetMap, self._answer_map)
        rospy.Service("change_map", LoadMap, self._change_map)

    def _show(self, loaded: tuple) -> OccupancyGrid:
        grid, yaw = loaded
        message = grid_message(grid, self._frame, rospy.Time.now())
        message.info.origin.orientation = quaternion_of(yaw)
        self._metadata_topic.publish(message.info)
        self._map_topic.publish(message)
        rospy.loginfo("Read a %d X %d map @ %.3f m/cell", message.info.width, message.info.height,
                      message.info.resolution)
        return message

    def _answer_map(self, _request: GetMapRequest) -> GetMapResponse:
        with self._lock:
            return MapAnswer(self._map)

    def _change_map(self, request: LoadMapRequest) -> LoadMapResponse:
        try:
            loaded = read_map(request.map_url)
        except MapFileError as error:
            rospy.logerr("change_map: %s; the map stays as it was", error)
            return LoadMapResponse(result=RESULTS[type(error)])
        with self._lock:
            self._map = self._show(loaded)
            rospy.loginfo("Changed map to %s", request.map_url)
            return LoadedMapAnswer(self._map, LoadMapResponse.RESULT_SUCCESS)


def main() -> int:
    """Runs the node until shutdown; returns the exit status."""
    arguments = rospy.myargv()[1:]
    if arguments and arguments[0] in ("-h", "--help"):
        print(USAGE)
        return 0
    init_node("map_server")
    try:
        values = _parameters()
        loaded = _load(arguments, values)
    except (MapFileError, ParameterError) as error:
        rospy.logerr("%s", error)
        return FAILED
    if wait_for_clock(MissingData()):  # a map's stamp must not be 0
        MapServer(loaded, values["frame_id"])
        spin()
    return 0


def _parameters() -> dict:
    folder = Path(rospkg.RosPack().get_path("map_server"))
    table = load_table(folder / "params" / "map_server.yaml")
    warn_of_ignored({"": table})
    return read_parameters(table)


def _load(arguments: list[str], values: dict) -> tuple:
    """The map that the command line names; raises MapFileError."""
    if len(arguments) == 1:
        return read_map(arguments[0])
    if len(arguments) != 2:
        raise MapFileError(f"map_server got {len(arguments)} arguments; {USAGE}")
    try:
        resolution = float(arguments[1])
    except ValueError:
        resolution = 0.0
    if not FINEST <= resolution <= COARSEST:
        raise MapFileError(f"{arguments[1]!r} is not a resolution; {USAGE}")
    if values["free_thresh"] > values["occupied_thresh"]:
        raise MapFileError("~free_thresh is above ~occupied_thresh: the two are the wrong way "
                           "round; write for example _free_thresh:=0.196")
    rospy.logwarn("map_server IMAGE RESOLUTION is deprecated: write a YAML file")
    return load_map(MapMetadata(
        Path(arguments[0]), resolution, negate=bool(values["negate"]),
        occupied_thresh=values["occupied_thresh"], free_thresh=values["free_thresh"]))
