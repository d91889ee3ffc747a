"""joint_trajectory_controller: joints that follow a trajectory, by topic or by action."""

import logging

import rospy
from actionlib import ServerGoalHandle
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryFeedback,
    FollowJointTrajectoryResult,
    JointTrajectoryControllerState,
)
from control_msgs.srv import (
    QueryTrajectoryState,
    QueryTrajectoryStateRequest,
    QueryTrajectoryStateResponse,
)
from trajectory_msgs.msg import JointTrajectory

from bullet_sim.control.rate import Rate
from bullet_sim.control.trajectory.follower import (
    Outcome,
    PidDrive,
    PositionDrive,
    TrajectoryFollower,
    Verdict,
)
from bullet_sim.control.trajectory.request import InvalidJoints, InvalidTrajectory
from bullet_sim.errors import PluginError
from bullet_sim_ros.control.actions import GoalSlot
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.pid import open_pid
from bullet_sim_ros.control.registry import Controller, controller
from bullet_sim_ros.control.trajectory_messages import (
    fill_state,
    goal_tolerances,
    read_tolerances,
    request_from_msg,
)

log = logging.getLogger("bullet_sim.control")
Result = FollowJointTrajectoryResult
CODES = {
    Verdict.REACHED: Result.SUCCESSFUL,
    Verdict.LEFT_PATH: Result.PATH_TOLERANCE_VIOLATED,
    Verdict.MISSED_GOAL: Result.GOAL_TOLERANCE_VIOLATED,
}
TYPES = {"position_controllers/JointTrajectoryController": "position",
         "velocity_controllers/JointTrajectoryController": "velocity",
         "effort_controllers/JointTrajectoryController": "effort",
         "pos_vel_controllers/JointTrajectoryController": None}


@controller(*TYPES)
class JointTrajectoryController(Controller):
    """After a violated tolerance the trajectory goes on; only the goal ends.

    So does joint_trajectory_controller_impl.h, checkPathTolerances. Positions are commanded
    directly; velocities and efforts come from a PID on the position, plus feed-forward. No
    simulated joint takes position and velocity at once (default_robot_hw_sim.cpp, initSim).

    PluginError if parameters are missing or wrong.
    """

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        p = context.parameters
        names, interface = p.texts("joints"), TYPES[p.text("type")]
        if interface is None:
            raise PluginError(
                "it needs joints with hardware_interface/PosVelJointInterface, which the simulated "
                "robot does not have; position_controllers/JointTrajectoryController does the same "
                "with hardware_interface/PositionJointInterface")
        self._drives = [self._make_drive(interface, name) for name in names]
        self._follower = TrajectoryFollower(
            [context.joint(name) for name in names], self._drives,
            p.number("stop_trajectory_duration", 0.0), p.flag("allow_partial_joints_goal", False))
        self._tolerances = read_tolerances(p, names)
        self._goal = GoalSlot()
        self._running = False
        self._time = 0.0
        self._state_pace = Rate(p.number("state_publish_rate", 50.0))
        self._goal_pace = Rate(p.number("action_monitor_rate", 20.0))
        self._open_topics()

    def _make_drive(self, interface: str, joint: str) -> PositionDrive | PidDrive:
        handle, p = self.context.claim(interface, joint), self.context.parameters
        if interface == "position":
            return PositionDrive(handle)
        return PidDrive(handle, open_pid(self.context, f"gains/{joint}"),
                        p.number(f"velocity_ff/{joint}", 0.0))

    def _open_topics(self) -> None:
        context = self.context
        self._state = context.advertise("state", JointTrajectoryControllerState, queue_size=1)
        context.serve("query_state", QueryTrajectoryState, self._query_state)
        context.action("follow_joint_trajectory", FollowJointTrajectoryAction, self._take_goal,
                       self._take_cancel)
        context.subscribe("command", JointTrajectory, lambda msg: lambda: self._follow(msg),
                          queue_size=1)

    # --- in the loop

    def start(self, time: float) -> None:
        """Hold the present position."""
        self._goal.preempt()
        for drive in self._drives:
            drive.restart()
        self._follower.start(time)
        self._running, self._time = True, time

    def update(self, time: float, period: float) -> None:
        """Follow the trajectory; publish state, feedback and results."""
        self._time = time
        outcome = self._follower.update(time, period)
        if outcome:
            self._finish(outcome)
        if self._goal.occupied and self._goal_pace.due(time):
            self._goal.publish_feedback(
                fill_state(FollowJointTrajectoryFeedback(), self._follower, time))
        if self._state_pace.due(time) and self._state.get_num_connections():
            self._state.publish(fill_state(JointTrajectoryControllerState(), self._follower, time))

    def stop(self, time: float) -> None:
        """Hold, and preempt the goal."""
        self._running = False
        self._follower.hold()
        self._goal.preempt()

    def _finish(self, outcome: Outcome) -> None:
        if outcome.text:
            log.warning("%s: goal aborted: %s", self.context.describe(), outcome.text)
        result = Result(error_code=CODES[outcome.verdict], error_string=outcome.text)
        self._goal.finish(outcome.verdict is Verdict.REACHED, result, outcome.text)

    def _take_goal(self, handle: ServerGoalHandle) -> None:
        goal = handle.get_goal()
        try:
            self._check_running()
            self._follower.follow(request_from_msg(goal.trajectory),
                                  goal_tolerances(goal, self._tolerances))
        except InvalidTrajectory as error:
            wrong_joints = isinstance(error, InvalidJoints)
            code = Result.INVALID_JOINTS if wrong_joints else Result.INVALID_GOAL
            log.error("%s: goal refused: %s", self.context.describe(), error)
            handle.set_rejected(Result(error_code=code, error_string=str(error)), str(error))
            return
        self._goal.accept(handle)

    def _take_cancel(self, handle: ServerGoalHandle) -> None:
        if self._goal.holds(handle):
            self._follower.hold()
            self._goal.preempt()

    def _follow(self, msg: JointTrajectory) -> None:
        try:
            self._check_running()
            self._follower.follow(request_from_msg(msg))
        except InvalidTrajectory as error:
            log.error("%s: command refused: %s", self.context.describe(), error)
            return
        self._goal.preempt()

    def _check_running(self) -> None:
        if not self._running:
            raise InvalidTrajectory("the controller is not running")

    # --- in ROS threads

    def _query_state(self, request: QueryTrajectoryStateRequest) -> QueryTrajectoryStateResponse:
        if not self._running:
            raise rospy.ServiceException(f"{self.context.describe()} is not running")
        states = self.context.mailbox.call(lambda: self._follower.sample(request.time.to_sec()))
        return QueryTrajectoryStateResponse(
            self._follower.names, [state.position for state in states],
            [state.velocity for state in states], [state.acceleration for state in states])
