"""Reads the parameters below a costmap's name: layers and sources, in both styles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import rospkg
import rospy
import yaml

from nav_nodes.parameters import Parameter, ParameterError, load_table

PARAMS = Path(rospkg.RosPack().get_path("costmap_2d")) / "params"

STATIC, OBSTACLE, VOXEL, INFLATION = "StaticLayer", "ObstacleLayer", "VoxelLayer", "InflationLayer"
TABLES = {STATIC: ("static_layer",), OBSTACLE: ("obstacle_layer",),
          VOXEL: ("obstacle_layer", "voxel_layer"), INFLATION: ("inflation_layer",)}
LARGEST = 5e8  # cells
# A layer takes these from the costmap's own namespace if set there, as in upstream.
OF_THE_COSTMAP = {
    STATIC: ("map_topic", "unknown_cost_value", "lethal_cost_threshold", "track_unknown_space"),
    OBSTACLE: ("max_obstacle_height", "raytrace_range", "obstacle_range", "track_unknown_space"),
    VOXEL: ("max_obstacle_height", "raytrace_range", "obstacle_range", "track_unknown_space",
            "origin_z", "z_resolution", "z_voxels", "mark_threshold", "unknown_threshold",
            "publish_voxel_map"),
    INFLATION: ("cost_scaling_factor", "inflation_radius")}
SEARCHED_UPWARDS = ("footprint", "robot_radius", "footprint_padding", "obstacle_range",
                    "raytrace_range")


@dataclass(frozen=True)
class LayerSettings:
    """One layer: `kind` is a key of TABLES, `values` are its parameters; sources by name."""

    name: str
    kind: str
    values: dict[str, Any]
    sources: dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Settings:
    """A costmap's own parameters by name, its layers, lowest first, and warnings.

    `tables`: parameters read, by namespace below the costmap's: "", "LAYER", "LAYER/SOURCE".
    """

    values: dict[str, Any]
    layers: list[LayerSettings]
    warnings: list[str]
    tables: dict[str, list[Parameter]]


@cache
def table(*names: str) -> list[Parameter]:
    """The tables of these files in params/, one after the other."""
    return [entry for name in names for entry in load_table(PARAMS / f"{name}.yaml")]


def read_settings(where: str) -> Settings:
    """`settings_of` the parameter server's content below the namespace `where`.

    Parameters that are searched upwards are searched from the node's own namespace.
    """
    outer = {key: rospy.search_param(key) for key in SEARCHED_UPWARDS}
    return settings_of(rospy.get_param(where, None) or {}, where,
                       {key: rospy.get_param(name) for key, name in outer.items() if name})


def settings_of(tree: Mapping[str, Any], where: str,
                outer: Mapping[str, Any] | None = None) -> Settings:
    """Settings of the parameters `tree` below the namespace `where` ("/move_base/local_costmap").

    `outer`: values of SEARCHED_UPWARDS in enclosing namespaces. Raises ParameterError for an
    invalid value.

    Without `plugins` there are the older style's layers, static_layer, obstacle_layer and
    inflation_layer. Upstream moves their parameters to the layers' namespaces and sets `plugins`,
    so that a second launch with a changed file still uses the first values; here they are read
    from where they are, each time.
    """
    tree = {**{key: value for key, value in (outer or {}).items() if key in SEARCHED_UPWARDS},
            **tree}
    values = _checked(table("costmap"), tree, where)
    warnings: list[str] = []
    chosen = (_chosen_layers(values["plugins"], where, warnings) if "plugins" in tree
              else _older_layers(tree, values))
    layers = [_layer(name, kind, tree, values, where) for name, kind in chosen]
    return Settings(values, layers, warnings, _tables(layers, "plugins" in tree))


def footprint_of(values: Mapping[str, Any], where: str) -> np.ndarray | None:
    """The polygon (K, 2), m, in `footprint`; None if `robot_radius` applies.

    Raises ParameterError for anything but three or more pairs of finite numbers, or none.
    """
    try:
        corners = np.asarray(yaml.safe_load(values["footprint"]) or [], float)
    except Exception:  # PyYAML also raises KeyError, IndexError and more
        corners = np.zeros(1)
    if not corners.size:
        return None
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 \
            or not np.isfinite(corners).all():
        raise ParameterError(f"{where}/footprint is {values['footprint']!r:.80}, but must be three "
                             "or more corners, such as [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1]]")
    return corners


def geometry_of(values: Mapping[str, Any], where: str
                ) -> tuple[tuple[int, int], float, tuple[float, float]]:
    """((rows, columns), resolution, origin), m, of a costmap that does not take a map's size.

    Raises ParameterError if there would be more than LARGEST cells.
    """
    resolution = values["resolution"]
    cells = [min(values[side] / resolution + 1e-9, LARGEST) for side in ("height", "width")]
    rows, columns = (max(1, int(each)) for each in cells)
    if rows * columns > LARGEST:
        raise ParameterError(f"{where}/width is {values['width']:g} and height "
                             f"{values['height']:g}, but that is more than {LARGEST:.0e} cells of "
                             f"{resolution:g} m")
    return (rows, columns), resolution, (values["origin_x"], values["origin_y"])


def _tables(layers: list[LayerSettings], by_plugins: bool) -> dict[str, list[Parameter]]:
    """The tables by namespace, including the older style's, directly below the costmap's name."""
    tables = {"": list(table("costmap"))}
    for layer in layers:
        entries = tables[layer.name] = table(*TABLES[layer.kind])
        above = {*OF_THE_COSTMAP[layer.kind], *(() if by_plugins else ["observation_sources"])}
        tables[""] += [entry for entry in entries if entry.name in above]
        for source in layer.sources:
            tables[f"{layer.name}/{source}"] = table("source")
            if not by_plugins:
                tables[source] = table("source")
    return tables


def _chosen_layers(plugins: list, where: str, warnings: list[str]) -> list[tuple[str, str]]:
    chosen = []
    for entry in plugins:
        if not isinstance(entry, dict) or not isinstance(entry.get("name"), str) \
                or not isinstance(entry.get("type"), str):
            raise ParameterError(f"{where}/plugins has {entry!r}, but must be a list of "
                                 "{name: ..., type: ...}")
        kind = entry["type"].replace("/", "::").rpartition("::")[2]
        if kind in TABLES:
            chosen.append((entry["name"], kind))
        else:
            warnings.append(f"{where}/plugins: {entry['name']} is left out: no layer of type "
                            f"{entry['type']}; there are "
                            f"{', '.join(f'costmap_2d::{known}' for known in TABLES)}")
    return chosen


def _older_layers(tree: Mapping[str, Any], values: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [*([("static_layer", STATIC)] if values["static_map"] else []),
            ("obstacle_layer", VOXEL if values["map_type"] == "voxel" else OBSTACLE),
            ("inflation_layer", INFLATION)]


def _layer(name: str, kind: str, tree: Mapping[str, Any], costmap_values: Mapping[str, Any],
           where: str) -> LayerSettings:
    own = tree.get(name)
    own = dict(own) if isinstance(own, dict) else {}
    if kind in (OBSTACLE, VOXEL):
        own.setdefault("track_unknown_space", costmap_values["track_unknown_space"])
    if "plugins" not in tree and "observation_sources" in tree:
        own["observation_sources"] = tree["observation_sources"]
    own.update({key: tree[key] for key in OF_THE_COSTMAP[kind] if key in tree})
    values = _checked(table(*TABLES[kind]), own, f"{where}/{name}")
    sources = {}
    for source in values.get("observation_sources", "").split():
        found = own.get(source)
        if "plugins" not in tree and isinstance(tree.get(source), dict):
            found = tree[source]
        found = {"topic": source, "obstacle_range": values["obstacle_range"],
                 "raytrace_range": values["raytrace_range"],
                 **(found if isinstance(found, dict) else {})}
        sources[source] = _checked(table("source"), found, f"{where}/{name}/{source}")
    return LayerSettings(name, kind, values, sources)


def _checked(entries: list[Parameter], found: Mapping[str, Any], where: str) -> dict[str, Any]:
    return {entry.name: entry.checked(found.get(entry.name, entry.default), f"{where}/{entry.name}")
            for entry in entries}
