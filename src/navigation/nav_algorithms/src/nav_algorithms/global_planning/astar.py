"""global_planner's planner: like navfn's, with a choice of its parts, such as A*."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.global_planning.navfn import plan_over
from nav_algorithms.global_planning.orientation import orient
from nav_algorithms.global_planning.potential import crossing_costs


@dataclass(frozen=True)
class GlobalPlannerSettings:
    """Parameters of global_planner/GlobalPlanner, except those of its topics."""

    allow_unknown: bool
    default_tolerance: float  # m, as navfn's
    use_dijkstra: bool        # else A*
    use_quadratic: bool       # interpolated distances in all directions, else along the grid
    use_grid_path: bool       # from cell to cell, else along the gradient
    old_navfn_behavior: bool  # use navfn's costs in place of the next three
    lethal_cost: int          # cells with at least this cost are not crossed
    neutral_cost: float
    cost_factor: float
    orientation_mode: int
    orientation_window_size: int


def plan(costmap: Costmap, start: np.ndarray, goal: np.ndarray, tolerance: float | None = None,
         *, settings: GlobalPlannerSettings) -> np.ndarray | None:
    """Path (N, 3) from `start` to `goal`, poses in the costmap's frame; None if there is none.

    As navfn's `plan`, but with yaws by `orientation_mode`. `old_navfn_behavior` uses navfn's
    costs; its start, which is off by half a cell, is not reproduced.
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
