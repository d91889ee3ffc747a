"""Controllers that hand commands on: effort, velocity and position, single and in groups."""

from bullet_sim.control.controllers.forward import Forward
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.controllers.command_topic import (
    command_timeout,
    subscribe_all,
    subscribe_one,
)
from bullet_sim_ros.control.registry import Controller, controller


class ForwardController(Controller):
    """The parameter `joint` or, for a group, `joints`."""

    interface = ""
    group = False

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        joints = (
            context.parameters.texts("joints") if self.group else [context.parameters.text("joint")]
        )
        handles = [context.claim(self.interface, joint) for joint in joints]
        self._law = Forward(handles, command_timeout(context))
        if self.group:
            subscribe_all(context, self._law.commands, len(handles))
        else:
            subscribe_one(context, self._law.commands)
        self.update = self._law.update  # each step counts: no call more than needed

    def start(self, time: float) -> None:
        """No effort, no speed, the present position, until a command comes."""
        self._law.start()


@controller("effort_controllers/JointEffortController")
class JointEffort(ForwardController):
    """N m or N."""
    interface = "effort"


@controller("velocity_controllers/JointVelocityController")
class JointVelocity(ForwardController):
    """rad/s or m/s."""
    interface = "velocity"


@controller("position_controllers/JointPositionController")
class JointPosition(ForwardController):
    """rad or m."""
    interface = "position"


@controller("effort_controllers/JointGroupEffortController")
class JointGroupEffort(JointEffort):
    """N m or N for each joint."""
    group = True


@controller("velocity_controllers/JointGroupVelocityController")
class JointGroupVelocity(JointVelocity):
    """rad/s or m/s for each joint."""
    group = True


@controller("position_controllers/JointGroupPositionController")
class JointGroupPosition(JointPosition):
    """rad or m for each joint."""
    group = True
