"""Builds layers from their settings, and applies changes by dynamic_reconfigure."""

from __future__ import annotations

from typing import Any

from costmap_2d.settings import INFLATION, STATIC, VOXEL, LayerSettings
from nav_algorithms.costmap.inflation import InflationLayer
from nav_algorithms.costmap.layer import Layer
from nav_algorithms.costmap.obstacles import ObstacleLayer
from nav_algorithms.costmap.static import StaticLayer
from nav_algorithms.costmap.voxels import VoxelLayer, VoxelSettings


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
