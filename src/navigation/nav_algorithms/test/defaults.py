"""Settings with the defaults of the nodes' parameter tables: the only place where they stand."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any

import yaml

NAVIGATION = Path(__file__).resolve().parents[2]
TABLES = {
    "DwaSettings": "move_base/params/dwa_planner", "NavfnSettings": "move_base/params/navfn",
    "TrajectoryRolloutSettings": "move_base/params/trajectory_planner",
    "PurePursuitSettings": "move_base/params/pure_pursuit",
    "GlobalPlannerSettings": "move_base/params/global_planner",
    "HybridAstarSettings": "move_base/params/hybrid_astar",
    "RotateSettings": "move_base/params/rotate_recovery",
    "EscapeSettings": "move_base/params/escape_recovery",
    "VoxelSettings": "costmap_2d/params/voxel_layer",
    "LocalisationSettings": "amcl/params/amcl", "SensorSettings": "amcl/params/amcl",
    "SlamSettings": "gmapping/params/slam_gmapping",
    "ScanSlamSettings": "hector_mapping/params/hector_mapping",
}


def of(kind: type, **changes: Any) -> Any:
    """A settings dataclass, with other values where `changes` has them."""
    values = {"controller_frequency": 20.0, **_defaults(TABLES[kind.__name__]), **changes}
    return kind(**{field.name: values[field.name] for field in fields(kind)})


@cache
def _defaults(table: str) -> dict[str, Any]:
    rows = yaml.safe_load((NAVIGATION / f"{table}.yaml").read_text(encoding="utf-8"))
    return {row["name"]: tuple(yaml.safe_load(row["default"])) if row["name"] == "y_vels"
            else row["default"] for row in rows}
