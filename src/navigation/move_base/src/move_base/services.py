"""The services of move_base, besides its action."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan, GetPlanRequest, GetPlanResponse
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from costmap_2d import CostmapROS
from move_base.global_planners import GlobalPlanner, path_message
from move_base.goals import in_frame
from nav_algorithms.costmap.costs import FREE, INSCRIBED, UNKNOWN, Costmap
from nav_nodes.transforms import Transforms

STEP_CELLS = 3  # between two alternative goal positions that are tried


class Services:
    """Made once; `~make_plan` answers only while there is no goal."""

    def __init__(self, costmaps: tuple[CostmapROS, CostmapROS], transforms: Transforms,
                 planner: Callable[[], GlobalPlanner], values: Callable[[], dict],
                 is_active: Callable[[], bool], clearing_radius: float) -> None:
        """`costmaps`: the global and the local one; `clearing_radius`, m."""
        self._costmaps, self._transforms = costmaps, transforms
        self._planner, self._values, self._is_active = planner, values, is_active
        self._clearing_radius = clearing_radius
        rospy.Service("~make_plan", GetPlan, self._make_plan)
        rospy.Service("~clear_costmaps", Empty, self._clear_costmaps)
        rospy.Service("~clear_unknown_space", Empty, self._clear_unknown_space)
        self._known: list[np.ndarray] = []  # poses around which nothing counts as unknown

    def costmap_to_plan_on(self) -> Costmap:
        """A copy of the global costmap, without the unknown space that was cleared."""
        snapshot = self._costmaps[0].snapshot()
        for pose in self._known:
            around = square(snapshot, pose, self._clearing_radius)
            snapshot.cells[around][snapshot.cells[around] == UNKNOWN] = FREE
        return snapshot

    def _clear_costmaps(self, _request: EmptyRequest) -> EmptyResponse:
        self._known = []
        for costmap in self._costmaps:
            costmap.reset_layers()
        return EmptyResponse()

    def _clear_unknown_space(self, _request: EmptyRequest) -> EmptyResponse:
        """As in older upstream: space around the robot counts as known, until ~clear_costmaps."""
        pose = self._costmaps[0].robot_pose()
        self._known = [*self._known, *([] if pose is None else [pose])]
        return EmptyResponse()

    def _make_plan(self, request: GetPlanRequest) -> GetPlanResponse:
        """An empty plan if there is no path, or if a pose is in a frame that nobody knows.

        As upstream the call fails where move_base is not ready to plan: rospy.ServiceException.
        """
        costmap = self._costmaps[0]
        if self._is_active():
            raise _refusal("move_base must be in an inactive state to make a plan for an external "
                           "user")
        if not costmap.is_ready():
            raise _refusal("move_base cannot make a plan for you because it doesn't have a costmap")
        robot = costmap.robot_pose()
        if robot is None and not request.start.header.frame_id:
            raise _refusal("move_base cannot make a plan for you because it could not get the "
                           "start pose of the robot")
        start = self._placed(request.start) if request.start.header.frame_id else robot
        goal = self._placed(request.goal)
        for which, pose, found in (("start", request.start, start), ("goal", request.goal, goal)):
            if found is None:
                rospy.logerr("make_plan: the %s is in frame %r, which cannot be transformed to %s: "
                             "the plan is empty", which, pose.header.frame_id, costmap.global_frame)
                return GetPlanResponse()
        snapshot = self.costmap_to_plan_on()
        if self._values()["make_plan_clear_costmap"] and robot is not None:
            snapshot.cells[square(snapshot, robot, self._clearing_radius)] = FREE
        path = self._near_goal(snapshot, start, goal, request.tolerance)
        response = GetPlanResponse()
        if path is not None:
            response.plan = path_message(path, costmap.global_frame, rospy.Time.now())
        return response

    def _placed(self, pose: PoseStamped) -> np.ndarray | None:
        return in_frame(pose, self._costmaps[0].global_frame, self._transforms)

    def _near_goal(self, snapshot: Costmap, start: np.ndarray, goal: np.ndarray,
                   tolerance: float) -> np.ndarray | None:
        """The path to the goal, or to the first place near it that has one."""
        frame, footprint = self._costmaps[0].global_frame, self._costmaps[0].footprint
        path = self._planner().plan(snapshot, footprint, start, goal, frame)
        if path is not None:
            return path
        widest = max(snapshot.cells.shape) * snapshot.resolution  # beyond it nothing is free
        for offset in offsets(min(tolerance, widest), snapshot.resolution):
            place = goal + np.array([*offset, 0.0])
            if not _is_open(snapshot, place):
                continue  # no planner would find a path to it
            path = self._planner().plan(snapshot, footprint, start, place, frame)
            if path is not None:
                add = self._values()["make_plan_add_unreachable_goal"]
                return np.vstack((path, goal)) if add else path
        return None


def offsets(tolerance: float, resolution: float) -> Iterator[tuple[float, float]]:
    """Places (x, y), m, around a goal, square by square, as upstream tries them."""
    step = STEP_CELLS * resolution
    if 0.0 < tolerance < step:
        step = tolerance
    for ring in range(1, int(tolerance / step + 1e-9) + 1 if tolerance > 0.0 else 1):
        for row in range(ring + 1):
            for column in range(ring + 1) if row == ring else (ring,):
                for y in ((-row, row) if row else (0,)):
                    for x in ((-column, column) if column else (0,)):
                        yield x * step, y * step


def square(costmap: Costmap, pose: np.ndarray, reach: float) -> tuple[slice, slice]:
    """The cells (rows, columns) up to `reach`, m, to each side of a pose."""
    low, high = (np.maximum(costmap.cells_of(pose[:2] + side * reach), edge)
                 for side, edge in ((-1, 0), (1, -1)))
    return slice(low[0], high[0] + 1), slice(low[1], high[1] + 1)


def _is_open(costmap: Costmap, pose: np.ndarray) -> bool:
    cell = costmap.cells_of(pose[:2])
    if not costmap.contains(cell):
        return False
    cost = costmap.cells[tuple(cell)]
    return cost < INSCRIBED or cost == UNKNOWN


def _refusal(why: str) -> rospy.ServiceException:
    """Logged here, and sent to the caller."""
    rospy.logerr("%s", why)
    return rospy.ServiceException(why)
