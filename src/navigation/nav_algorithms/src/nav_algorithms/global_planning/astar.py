"""global_planner's planner: navfn's with its parts to choose from, A* among them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.global_planning.navfn import plan_over
from nav_algorithms.global_planning.orientation import orient
from nav_algorithms.global_planning.potential import crossing_costs


@dataclass(frozen=True)
class GlobalPlannerSettings:
    """Names of global_planner/GlobalPlanner. Pictures belong to its node."""

    allow_unknown: bool
    default_tolerance: float  # m, as navfn's
    use_dijkstra: bool        # else A*
    use_quadratic: bool       # distances as the crow flies, else as the streets go
    use_grid_path: bool       # from cell to cell, else along the slope
    old_navfn_behavior: bool  # navfn's costs in place of the next three
    lethal_cost: int          # from here on no cell is crossed
    neutral_cost: float
    cost_factor: float
    orientation_mode: int
    orientation_window_size: int


def plan(costmap: Costmap, start: np.ndarray, goal: np.ndarray, tolerance: float | None = None,
         *, settings: GlobalPlannerSettings) -> np.ndarray | None:
    """Path (N, 3) from `start` to `goal`, poses in the costmap's frame; None where there is none.

    As navfn's `plan`, but yaws are those of `orientation_mode`. `old_navfn_behavior` takes navfn's
    costs; its off-by-half-a-cell start is not repeated.
    """
    neutral, factor = ((50.0, 0.8) if settings.old_navfn_behavior
                       else (settings.neutral_cost, settings.cost_factor))
    unknown = float(settings.lethal_cost - 1) if settings.allow_unknown else np.inf
    cost = crossing_costs(costmap.cells, neutral, factor, settings.lethal_cost, unknown)
    path = plan_over(costmap, cost, start, goal,
                     settings.default_tolerance if tolerance is None else tolerance,
                     settings.use_quadratic, 0.0 if settings.use_dijkstra else neutral,
                     not settings.use_grid_path)
    if path is None:
        return None
    return orient(path, settings.orientation_mode, settings.orientation_window_size)
