"""One costmap of a node: upstream's Costmap2DROS, with its layers made from their settings."""

from __future__ import annotations

import threading
import time
import traceback
from functools import partial
from typing import Any

import numpy as np
import rospy

from costmap_2d.map_input import MapInput
from costmap_2d.publishing import CostmapPublisher
from costmap_2d.settings import (
    INFLATION,
    STATIC,
    TABLES,
    VOXEL,
    LayerSettings,
    footprint_of,
    geometry_of,
    read_settings,
    table,
)
from costmap_2d.sources import MessageAge, Sensors
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.costmap.footprint import circle, padded
from nav_algorithms.costmap.inflation import InflationLayer
from nav_algorithms.costmap.layer import Layer
from nav_algorithms.costmap.layered import LayeredCostmap
from nav_algorithms.costmap.obstacles import ObstacleLayer
from nav_algorithms.costmap.static import StaticLayer
from nav_algorithms.costmap.voxels import VoxelLayer, VoxelSettings
from nav_algorithms.poses import transform_points
from nav_nodes.missing_data import MissingData
from nav_nodes.parameters import serve_changes
from nav_nodes.transforms import Transforms

OUTLINE = ("footprint", "robot_radius", "footprint_padding")
ANY_OBSTACLES = "obstacles"  # the default of clear_costmap_recovery's layer_names
EASY = 0.8  # of the time between two updates, for one of them
IDLE = 0.1                   # s of wall time between two checks while there is nothing to do
OVERDUE = 1.0                # s, least age of the last update at which it is no longer current


class CostmapROS:
    """A costmap with its parameters, sensors and topics below `~NAME/`, kept by its own thread.

    Nothing here waits for a map, a sensor or a transform: missing ones are logged, and `is_ready`
    tells whether the first complete update was made. All methods may be called on any thread.
    """

    def __init__(self, name: str, transforms: Transforms, missing_data: MissingData) -> None:
        """Reads `~NAME/...` (all that is in `tables`), subscribes, and starts updating.

        Raises nav_nodes.parameters.ParameterError for an invalid parameter.
        """
        self.name = name
        self._where = rospy.resolve_name(f"~{name}")
        self.transforms, self._missing_data = transforms, missing_data
        self._lock = threading.RLock()
        self._ready = threading.Event()
        self._paused = self._stopped = False
        self._published_at = self._updated_at = rospy.Time(0)
        settings = read_settings(self._where)
        for warning in settings.warnings:
            rospy.logerr("%s", warning)
        self._values, self.tables = settings.values, settings.tables
        self.global_frame = self._values["global_frame"].lstrip("/")
        self.base_frame = self._values["robot_base_frame"].lstrip("/")
        self.transform_tolerance = self._values["transform_tolerance"]
        layers = [build_layer(layer, self._values["rolling_window"]) for layer in settings.layers]
        self._layered = LayeredCostmap(layers, *geometry_of(self._values, self._where),
                                       self._values["rolling_window"],
                                       self._values["track_unknown_space"])
        self._set_footprint(self._values)
        self._publisher = CostmapPublisher(
            name, self.global_frame, self._values["always_send_full_costmap"],
            lambda: self.snapshot() if self.is_ready() else None)
        pairs = list(zip(settings.layers, layers, strict=True))
        self._maps = [MapInput(each.values, layer, self._layered, self._lock)
                      for each, layer in pairs if isinstance(layer, StaticLayer)]
        self._sensors = Sensors(settings.layers, self.global_frame, transforms, missing_data)
        self._servers = [serve_changes(table("costmap"), self._values, self._change, f"~{name}")]
        for each, layer in pairs:
            self._servers.append(serve_changes(table(*TABLES[each.kind]), each.values, partial(
                self._change_layer, layer), f"~{name}/{each.name}"))
        self.start()
        threading.Thread(target=self._keep_updating, name=name, daemon=True).start()

    @property
    def footprint(self) -> np.ndarray:
        """(K, 2), m, in the base frame, with its padding; a circle's 16 corners by default."""
        return self._padded.copy()

    @property
    def bare_footprint(self) -> np.ndarray:
        """(K, 2), m, without the padding."""
        return self._bare.copy()

    def snapshot(self) -> Costmap:
        """A copy of the newest complete update, which the caller may modify."""
        with self._lock:
            newest = self._layered.newest
            return Costmap(newest.cells.copy(), newest.resolution, newest.origin)

    def robot_pose(self) -> np.ndarray | None:
        """(x, y, yaw) in the global frame; None if tf has none, or none within the tolerance."""
        return self.transforms.newest_pose(self.global_frame, self.base_frame,
                                           self.transform_tolerance)

    def is_ready(self) -> bool:
        """Whether the map (if required) and the robot's pose have come, and an update was made."""
        return self._ready.is_set()

    def is_current(self) -> bool:
        """Whether it is ready, and no update or sensor (by `expected_update_rate`) is overdue."""
        frequency = self._values["update_frequency"]
        age = (rospy.Time.now() - self._updated_at).to_sec()
        if not self.is_ready() or (frequency and not self._paused
                                   and age > max(OVERDUE, 3 / frequency)):
            return False
        return self._sensors.are_current()

    def ages(self) -> list[MessageAge]:
        """When each sensor last sent a message, and when a usable one."""
        return self._sensors.ages()

    def orphaned_maps(self) -> list[str]:
        """Topics of maps that have lost their publisher; the last map is still used."""
        return [topic for each in self._maps if (topic := each.orphaned) is not None]

    def start(self) -> None:
        """Resumes sensors and updates after `stop`; does not wait."""
        self._stopped = False
        self._sensors.start()

    def stop(self) -> None:
        """Unsubscribes from the sensors and stops updating (shutdown_costmaps)."""
        self._stopped = True
        self._ready.clear()
        self._sensors.stop()

    def pause(self) -> None:
        """Stops updating, but keeps receiving."""
        self._paused = True

    def resume(self) -> None:
        """Ends a pause."""
        self._paused = False

    def update(self) -> bool:
        """Updates now, on the caller's thread; False if the map or the pose is missing."""
        missing = [each for each in self._maps if not each.has_map(self._missing_data)]
        pose = None if missing else self.robot_pose()
        if pose is None:
            return False
        with self._lock:
            for each in self._maps:
                each.place(self.transforms, self.global_frame)
            self._sensors.observe(self._layered.layers)
            self._publisher.note(self._layered.update(pose))
        self._publisher.publish_footprint(transform_points(pose, self._padded))
        self._updated_at = rospy.Time.now()
        if not self._stopped:
            self._ready.set()
        return True

    def layer_names(self) -> list[str]:
        """In their order, such as ["static_layer", "obstacle_layer", "inflation_layer"]."""
        return [layer.name for layer in self._layered.layers]

    def reset_layers(self) -> None:
        """Every layer forgets sensor data and reloads its map (~clear_costmaps)."""
        with self._lock:
            self._layered.reset()

    def clear_area(self, distance: float, layer_names: list[str] | None = None,
                   invert: bool = False) -> bool:
        """Layers forget what lies outside a square of side `distance`, m, around the robot.

        With `invert`: inside it. `layer_names`: of clear_costmap_recovery; "obstacles", or None,
        means each layer filled by sensors. False without a pose. Takes effect with the next update.
        """
        pose = self.robot_pose()
        if pose is None:
            return False
        names = layer_names or [ANY_OBSTACLES]
        with self._lock:
            for layer in self._layered.layers:
                if layer.name in names or (layer.from_sensors and ANY_OBSTACLES in names):
                    layer.clear_area(pose[:2] - distance / 2, pose[:2] + distance / 2, invert)
        return True

    def _keep_updating(self) -> None:
        while not rospy.is_shutdown():
            try:
                self._update_and_rest()
            except rospy.ROSTimeMovedBackwardsException:
                self.transforms.buffer.clear()  # else it would use the newest from before
                self._sensors.forget()
            except rospy.ROSInterruptException:
                return
            except Exception:  # if this thread ended, the robot would never drive again
                rospy.logerr_throttle(5.0, f"{self.name}: an update failed: "
                                           + traceback.format_exc())
                time.sleep(IDLE)

    def _update_and_rest(self) -> None:
        frequency = self._values["update_frequency"]
        if not frequency or self._paused or self._stopped or rospy.Time.now().is_zero():
            time.sleep(IDLE)
            return
        began = rospy.Time.now()
        if self.update():
            self._publish_if_due()
        took, period = (rospy.Time.now() - began).to_sec(), 1 / frequency
        if took < 0:  # else it would sleep until the old time is reached
            raise rospy.ROSTimeMovedBackwardsException(took)
        if took > period:
            rospy.logwarn_throttle(5.0, "%s: an update took %.2f s, but update_frequency is %g Hz: "
                                        "end other programs, or write in its YAML file "
                                        "update_frequency: %.1g, or a larger resolution",
                                   self.name, took, frequency, EASY / took)
        rospy.sleep(max(period - took, 0.001))

    def _publish_if_due(self) -> None:
        now, frequency = rospy.Time.now(), self._values["publish_frequency"]
        due = frequency > 0 and abs((now - self._published_at).to_sec()) >= 0.99 / frequency
        if due or self._publisher.is_wanted():
            self._published_at = now
            self._publisher.publish(self.snapshot())

    def _set_footprint(self, values: dict[str, Any]) -> None:
        corners = footprint_of(values, self._where)
        with self._lock:
            self._bare = circle(values["robot_radius"]) if corners is None else corners
            self._padded = padded(self._bare, values["footprint_padding"])
            self._layered.set_footprint(self._padded)

    def _change(self, values: dict[str, Any]) -> None:
        """dynamic_reconfigure of the costmap's own parameters."""
        before, geometry = self._values, geometry_of(values, self._where)
        with self._lock:
            if any(values[key] != before[key] for key in OUTLINE):
                self._set_footprint(values)
            if geometry != geometry_of(before, self._where) and not (
                    self._maps and not values["rolling_window"]):
                self._layered.resize(*geometry)
            self.transform_tolerance = values["transform_tolerance"]
            self._values = values

    def _change_layer(self, layer: Any, values: dict[str, Any]) -> None:
        """dynamic_reconfigure of a layer's parameters."""
        with self._lock:
            change_layer(layer, values)
            self._layered.write_all()


def build_layer(settings: LayerSettings, rolling: bool) -> Layer:
    """The layer that settings describe."""
    values, name = settings.values, settings.name
    if settings.kind == STATIC:
        layer = StaticLayer(name, rolling, values["use_maximum"])
    elif settings.kind == INFLATION:
        layer = InflationLayer(name, values["inflation_radius"], values["cost_scaling_factor"],
                               values["inflate_unknown"])
    else:
        shared = {"track_unknown": values["track_unknown_space"],
                  "combination_method": values["combination_method"],
                  "max_obstacle_height": values["max_obstacle_height"],
                  "clears_footprint": values["footprint_clearing_enabled"]}
        layer = (VoxelLayer(name, _voxels(values), **shared) if settings.kind == VOXEL
                 else ObstacleLayer(name, **shared))
    layer.enabled = values["enabled"]
    return layer


def change_layer(layer: Layer, values: dict[str, Any]) -> None:
    """Applies the parameters that may change at run time; all cells must be written again then."""
    layer.enabled = values["enabled"]
    if isinstance(layer, InflationLayer):
        layer.change(values["inflation_radius"], values["cost_scaling_factor"],
                     values["inflate_unknown"], values["enabled"])
    elif isinstance(layer, ObstacleLayer):
        layer.combination_method = values["combination_method"]
        layer.max_obstacle_height = values["max_obstacle_height"]
        layer.clears_footprint = values["footprint_clearing_enabled"]
    if isinstance(layer, VoxelLayer):
        layer.change_settings(_voxels(values))


def _voxels(values: dict[str, Any]) -> VoxelSettings:
    return VoxelSettings(**{name: values[name] for name in VoxelSettings.__dataclass_fields__})
