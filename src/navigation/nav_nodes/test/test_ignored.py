"""What the one warning of ignored parameters names; no master."""

import pytest

from nav_nodes.ignored import ignored
from nav_nodes.parameters import Parameter

TABLES = {
    "": [Parameter("planner_frequency", "double", 0.0)],
    "DWAPlannerROS": [
        Parameter("max_vel_trans", "double", 0.55, was=("max_trans_vel",)),
        Parameter("pdist_scale", "double", 0.6, also=("path_distance_bias",)),
        Parameter("prune_plan", "bool", False, status="accepted", meaning="always"),
        Parameter("lstep", "double", 0.05, status="differs", meaning="a step")],
    "local_costmap/scan": [Parameter("topic", "str", "")],
    "local_costmap": [Parameter("width", "double", 10.0)],
}


@pytest.mark.parametrize("tree, said", [
    ({"planner_frequency": 1.0,
      "DWAPlannerROS": {"max_vel_trans": 1, "path_distance_bias": 1}}, []),
    ({"planer_frequency": 1.0}, ["planer_frequency (did you mean planner_frequency?)"]),
    ({"y_vels": "[]"}, ["y_vels"]),
    ({"DWAPlannerROS": {"max_trans_vel": 1.0}},
     ["DWAPlannerROS/max_trans_vel (now max_vel_trans)"]),
    ({"DWAPlannerROS": {"prune_plan": True}}, ["DWAPlannerROS/prune_plan (always)"]),
    ({"DWAPlannerROS": {"lstep": 0.1}},
     ["DWAPlannerROS/lstep (has another meaning: a step)"]),
    ({"DWAPlannerROS": {"prune_plan": False, "lstep": 0.05}}, []),
    ({"TebLocalPlannerROS": {"max_vel_x": 1.0}}, []),
    ({"DWAPlanerROS": {"max_vel_trans": 1.0}},
     ["DWAPlanerROS (did you mean DWAPlannerROS?)"]),
    ({"local_costmap": {"with": 3, "scan": {"topik": "scan"}}},
     ["local_costmap/with (did you mean width?)",
      "local_costmap/scan/topik (did you mean topic?)"]),
    ({"saved_pose": {"pose": []}}, []),
])
def test_what_is_said(tree, said):
    assert list(ignored(tree, TABLES, ["saved_pose"])) == said
