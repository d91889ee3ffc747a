"""gripper_action_controller: one joint, driven by position or effort, behind an action."""

import logging

from actionlib import ServerGoalHandle
from control_msgs.msg import GripperCommandAction, GripperCommandFeedback, GripperCommandResult

from bullet_sim.control.controllers import gripper
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.rate import Rate
from bullet_sim_ros import convert
from bullet_sim_ros.control.actions import GoalSlot
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.pid import open_pid
from bullet_sim_ros.control.registry import Controller, controller

log = logging.getLogger("bullet_sim.control")


TYPES = {"position_controllers/GripperActionController": "position",
         "effort_controllers/GripperActionController": "effort"}


@controller(*TYPES)
class GripperActionController(Controller):
    """A stalled goal is aborted; the joint keeps its effort.

    So does gripper_action_controller_impl.h, checkForSuccess. With the position interface,
    max_effort is only reported; with effort, a PID with `gains/<joint>` acts up to max_effort.
    """

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        p = context.parameters
        interface, joint = TYPES[p.text("type")], p.text("joint")
        handle = context.claim(interface, joint)
        move = (gripper.move_by_position(handle) if interface == "position" else
                gripper.move_by_effort(handle, open_pid(context, f"gains/{joint}")))
        self._gripper = gripper.Gripper(handle, move, _options(p))
        self._goal = GoalSlot()
        self._running = False
        self._pace = Rate(p.number("action_monitor_rate", 20.0))
        context.action("gripper_cmd", GripperCommandAction, self._take_goal, self._take_cancel)

    def start(self, time: float) -> None:
        """Hold the present position."""
        self._gripper.start(time)
        self._running = True

    def update(self, time: float, period: float) -> None:
        """Move, and publish feedback or the result."""
        outcome = self._gripper.update(time, period)
        if outcome:
            self._goal.finish(outcome.reached_goal, _filled(GripperCommandResult(), outcome))
        elif self._goal.occupied and self._pace.due(time):
            self._goal.publish_feedback(_filled(GripperCommandFeedback(), self._gripper.state()))

    def stop(self, time: float) -> None:
        """Hold, and preempt the goal."""
        self._running = False
        self._gripper.hold()
        self._goal.preempt()

    def _take_goal(self, handle: ServerGoalHandle) -> None:
        command = handle.get_goal().command
        problem = self._problem(command.position, command.max_effort)
        if problem:
            log.error("%s: goal refused: %s", self.context.describe(), problem)
            handle.set_rejected(GripperCommandResult(), problem)
            return
        self._goal.accept(handle)
        self._gripper.pursue(self.context.world_time(), command.position, command.max_effort)

    def _problem(self, *values: float) -> str:
        if not self._running:
            return "the controller is not running"
        if not all(abs(value) <= convert.LARGEST for value in values):
            return "position and max_effort must be finite numbers"
        return ""

    def _take_cancel(self, handle: ServerGoalHandle) -> None:
        if self._goal.holds(handle):
            self._gripper.hold()
            self._goal.preempt()


def _options(parameters: ControllerParameters) -> gripper.GripperOptions:
    default = gripper.GripperOptions()
    return gripper.GripperOptions(*(
        abs(parameters.number(name, getattr(default, name)))
        for name in ("goal_tolerance", "max_effort", "stall_velocity_threshold", "stall_timeout")))


def _filled(msg, state: gripper.GripperState):
    msg.position, msg.effort = state.position, state.effort
    msg.stalled, msg.reached_goal = state.stalled, state.reached_goal
    return msg
