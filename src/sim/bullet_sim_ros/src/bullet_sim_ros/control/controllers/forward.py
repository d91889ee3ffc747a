"""Controllers that forward commands: effort, velocity and position, single and in groups."""

from bullet_sim.control.controllers.forward import Forward
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.controllers.command_topic import command_timeout, subscribe
from bullet_sim_ros.control.registry import Controller, controller

TYPES = {  # interface (N m or N, rad/s or m/s, rad or m), and whether it controls a group
    "effort_controllers/JointEffortController": ("effort", False),
    "velocity_controllers/JointVelocityController": ("velocity", False),
    "position_controllers/JointPositionController": ("position", False),
    "effort_controllers/JointGroupEffortController": ("effort", True),
    "velocity_controllers/JointGroupVelocityController": ("velocity", True),
    "position_controllers/JointGroupPositionController": ("position", True),
}


@controller(*TYPES)
class ForwardController(Controller):
    """Controls the joint of the parameter `joint` or, for a group, those of `joints`."""

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        p = context.parameters
        interface, group = TYPES[p.text("type")]
        joints = p.texts("joints") if group else [p.text("joint")]
        self._law = Forward([context.claim(interface, joint) for joint in joints],
                            command_timeout(context))
        subscribe(context, self._law.commands, len(joints), group)
        self.update = self._law.update  # called at each step: saves a function call

    def start(self, time: float) -> None:
        """Command zero effort, zero velocity or the present position until a command comes."""
        self._law.start()
