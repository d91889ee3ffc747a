"""The node move_base: its action and its parts."""

from __future__ import annotations

import time

import actionlib
import numpy as np
import rospy
from actionlib.server_goal_handle import ServerGoalHandle
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import (
    MoveBaseAction,
    MoveBaseActionGoal,
    MoveBaseFeedback,
    MoveBaseGoal,
)

from costmap_2d import CostmapROS
from costmap_2d.settings import SEARCHED_UPWARDS
from move_base.base import Base
from move_base.exported_planners import global_planner, local_planner
from move_base.goals import INVALID, fault_of, in_frame
from move_base.navigator import Navigator, Outcome
from move_base.planning import CannotPlanYet, Planning
from move_base.plugin import settings_from, table
from move_base.recoveries import load
from move_base.services import Services
from move_base.state_machine import Patience, State, StateMachine
from move_base.watch import Watch
from nav_algorithms.costmap.footprint import reach
from nav_nodes.ignored import below, warn_of_ignored
from nav_nodes.messages import stamped_pose
from nav_nodes.missing_data import MissingData, watch_clock
from nav_nodes.parameters import ParameterError, read_parameters, serve_changes
from nav_nodes.program import init_node, spin
from nav_nodes.transforms import Transforms


def keep_telling(server: actionlib.SimpleActionServer) -> None:
    """Call once, after the server's start: actionlib's own timer ends when the clock goes back."""
    actions = server.action_server
    if actions.status_timer is not None:
        actions.status_timer.shutdown()
        actions.status_timer = rospy.Timer(rospy.Duration(1.0 / actions.status_frequency),
                                           actions.publish_status_async, reset=True)


KILLED = "Aborting on the goal because the node has been killed"
SLICE = 0.005  # s of wall time between two checks of the clock


class MoveBase:
    """The node, as upstream's. Make one only, after rospy.init_node."""

    def __init__(self) -> None:
        """Raises ParameterError for invalid parameters, including unknown planners."""
        values = self._values = read_parameters(table("move_base"))
        kinds = self._planner_kinds(values)
        missing_data = MissingData()
        watch_clock(missing_data)
        self._transforms = Transforms(missing_data)
        self._costmaps = (CostmapROS("global_costmap", self._transforms, missing_data),
                          CostmapROS("local_costmap", self._transforms, missing_data))
        frames = [costmap.global_frame for costmap in self._costmaps]
        self._transforms.chain = *dict.fromkeys(frames), self._costmaps[0].base_frame
        self._global_planner = kinds[0](self._costmaps[0])
        driver = kinds[1](values["controller_frequency"], self._costmaps)
        self._base = Base(values["command_type"], values["wheelbase"],
                          driver.values["odom_topic"], values["stop_guard"])
        self._machine = StateMachine(settings_from(Patience, values))
        radius = reach(self._costmaps[0].bare_footprint)
        recoveries = load(values, radius)
        self._machine.recoveries = len(recoveries)
        planning = Planning(self._machine, self._plan, self._period)
        self._navigator = Navigator(
            self._costmaps, self._transforms, self._base,
            Watch(self._costmaps, self._base, self._transforms.buffer, missing_data),
            self._machine, planning, driver, recoveries)
        self._current_goal = rospy.Publisher("~current_goal", PoseStamped, queue_size=1)
        self._server = actionlib.SimpleActionServer("move_base", MoveBaseAction, self._execute,
                                                    auto_start=False)
        clearing = values["clearing_radius"] if values["clearing_radius"] >= 0.0 else radius
        self._services = Services(self._costmaps, self._transforms, lambda: self._global_planner,
                                  lambda: self._values, self._server.is_active, clearing)
        self._rest_costmaps()
        self._reconfigure = serve_changes(table("move_base"), values, self._change)
        rospy.on_shutdown(self._close)
        self._goals = rospy.Publisher("move_base/goal", MoveBaseActionGoal, queue_size=1)
        rospy.Subscriber("move_base_simple/goal", PoseStamped, self._take_simple_goal,
                         queue_size=1)
        self._server.start()
        keep_telling(self._server)
        tables = {each.NAME: each.entries for each in (self._global_planner, driver)
                  if each.TABLE}  # planners of other packages read what they like
        tables |= {each.name: each.entries for each in recoveries} | {"": table("move_base")}
        for each in self._costmaps:
            tables |= below(each.name, each.tables)
        warn_of_ignored(tables, SEARCHED_UPWARDS)

    def _planner_kinds(self, values: dict) -> tuple[type, type]:
        return tuple(find(values[name], rospy.resolve_name(f"~{name}"))
                     for name, find in (("base_global_planner", global_planner),
                                        ("base_local_planner", local_planner)))

    def _period(self) -> float:
        return 1.0 / self._values["controller_frequency"]

    def _change(self, values: dict) -> None:
        """dynamic_reconfigure."""
        kinds = self._planner_kinds(values)
        if not isinstance(self._global_planner, kinds[0]):
            before, self._global_planner = self._global_planner, kinds[0](self._costmaps[0])
            before.close()
        if not isinstance(self._navigator.local_planner, kinds[1]):
            before = self._navigator.local_planner
            self._navigator.local_planner = kinds[1](values["controller_frequency"],
                                                     self._costmaps)
            before.close()
            self._base.listen_to(self._navigator.local_planner.values["odom_topic"])
        self._navigator.local_planner.at_frequency(values["controller_frequency"])
        self._machine.patience = settings_from(Patience, values)
        self._values = values

    def _take_simple_goal(self, pose: PoseStamped) -> None:
        goal = MoveBaseActionGoal()
        goal.header.stamp = rospy.Time.now()
        goal.goal.target_pose = pose
        self._goals.publish(goal)

    def _plan(self, goal: PoseStamped) -> np.ndarray | None:
        """Plan a path; called on the planner's thread."""
        costmap = self._costmaps[0]
        start = costmap.robot_pose() if costmap.is_ready() else None
        if start is None:
            raise CannotPlanYet
        place = in_frame(goal, costmap.global_frame, self._transforms)
        if place is None:
            return None
        return self._global_planner.plan(self._services.costmap_to_plan_on(), costmap.footprint,
                                         start, place, costmap.global_frame)

    def _execute(self, goal: MoveBaseGoal) -> None:
        """Runs on the action's thread until the goal, or one that replaced it, has ended.

        Stops the robot then, also after an exception, which actionlib reports to the client.
        """
        for costmap in self._costmaps if self._values["shutdown_costmaps"] else ():
            costmap.start()
        try:
            outcome = self._outcome_of(goal)
        finally:
            self._navigator.end()
            self._rest_costmaps()
        if rospy.is_shutdown():
            return  # _close has told the client
        if outcome is None:
            self._server.set_preempted()
        elif outcome.succeeded:
            self._server.set_succeeded(text=outcome.text)
        else:
            self._server.set_aborted(text=outcome.text)

    def _outcome_of(self, goal: MoveBaseGoal) -> Outcome | None:
        """Outcome of the goal, or of the last one that replaced it; None if it was cancelled."""
        while True:
            fault = fault_of(goal.target_pose.pose.orientation)
            if fault is not None:
                rospy.logerr("%s", fault)
                return Outcome(False, INVALID)
            outcome = self._pursue(goal.target_pose)
            if outcome is not None or not self._server.is_new_goal_available():
                return outcome
            goal = self._server.accept_new_goal()

    def _pursue(self, goal: PoseStamped) -> Outcome | None:
        """Drive until the goal has ended; None if it was cancelled or replaced."""
        place = in_frame(goal, self._costmaps[0].global_frame, self._transforms)
        if place is not None:  # so that a goal in the robot's frame stays where it was
            goal = stamped_pose(place, self._costmaps[0].global_frame, rospy.Time.now())
        self._navigator.begin(goal)
        self._current_goal.publish(goal)
        while not rospy.is_shutdown() and not self._server.is_preempt_requested():
            began, frequency = rospy.get_time(), self._values["controller_frequency"]
            where, outcome = self._navigator.cycle(began, self._values)
            if where is not None:
                self._server.publish_feedback(MoveBaseFeedback(where))
            if outcome is not None:
                return outcome
            took = rospy.get_time() - began
            if took > 1.0 / frequency and self._machine.state is State.CONTROLLING:
                rospy.logwarn_throttle(5.0, "Control loop missed its desired rate of %.4fHz... "
                                       "the loop actually took %.4f seconds", frequency, took)
            self._wait_until(began, 1.0 / frequency)
        return None

    def _wait_until(self, began: float, period: float) -> None:
        """Wait for the cycle's end; a cancelled goal does not wait for a paused clock."""
        now = rospy.get_time()
        while (began <= now < began + period and not rospy.is_shutdown()
               and not self._server.is_preempt_requested()):
            time.sleep(max(min(began + period - now, 4 * SLICE), SLICE / 5))
            now = rospy.get_time()
        if now < began:
            self._begin_time_anew(now)

    def _begin_time_anew(self, now: float) -> None:
        """The clock was set back; upstream then refuses all goals until the old time is reached."""
        rospy.logwarn("the clock was set back to %.2f s: patience starts again", now)
        self._machine.hold(now)
        for handle in (self._server.current_goal, self._server.next_goal):
            if isinstance(handle, ServerGoalHandle) and handle.status_tracker is not None:
                handle.status_tracker.status.goal_id.stamp = rospy.Time(0)

    def _rest_costmaps(self) -> None:
        for costmap in self._costmaps if self._values["shutdown_costmaps"] else ():
            costmap.stop()

    def _close(self) -> None:
        """At shutdown: stop the robot and tell the client."""
        self._base.close()
        try:
            if self._server.is_active():
                self._server.set_aborted(text=KILLED)
        except rospy.ROSException:
            pass  # its topics are already closed


def main() -> int:
    """Runs the node until shutdown; returns the exit status."""
    init_node("move_base")
    try:
        MoveBase()
    except ParameterError as error:
        rospy.logfatal("%s", error)
        return 1
    spin()
    return 0
