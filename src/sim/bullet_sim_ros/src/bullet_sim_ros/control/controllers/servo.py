"""Controllers with a PID: position and velocity by effort, position by velocity."""

from control_msgs.msg import JointControllerState

from bullet_sim.control.controllers.servo import PositionServo, Servo, Servos, VelocityServo
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.controllers.command_topic import (
    command_timeout,
    subscribe_all,
    subscribe_one,
)
from bullet_sim_ros.control.pid import PidTopic, open_pid
from bullet_sim_ros.control.registry import Controller, controller

STATE_EVERY = 10  # updates


class ServoController(Controller):
    """One joint, parameters `joint` and `pid/...`; topic `state` has target, value and command."""

    interface = "effort"
    law: type[Servo] = PositionServo

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        self._topics: list[PidTopic] = []
        joint = context.parameters.text("joint")
        self._servo = self._open_servo(joint, "pid")
        self._servos = Servos([self._servo], command_timeout(context))
        self._state = context.advertise("state", JointControllerState, queue_size=1)
        self._updates = 0
        subscribe_one(context, self._servos.commands)

    def _open_servo(self, joint: str, group: str) -> Servo:
        context = self.context
        handle = context.claim(self.interface, joint)
        if self.law is PositionServo:
            context.robot.limits(joint)  # a joint that the URDF does not have is an error
        pid = open_pid(context, group)
        if context.parameters.flag(f"{group}/publish_state", False):
            self._topics.append(PidTopic(context, pid, group))
        return self.law(handle, pid)

    def start(self, time: float) -> None:
        """Keep the joint as it is until a command comes."""
        self._servos.start()
        self._updates = 0

    def update(self, time: float, period: float) -> None:
        """Write the command; publish the state every tenth time."""
        self._servos.update(time, period)
        if self._updates % STATE_EVERY == 0 and self._state.get_num_connections():
            self._state.publish(self._message(time, period))
        self._updates += 1
        for topic in self._topics:
            topic.publish(time, period)

    def _message(self, time: float, period: float) -> JointControllerState:
        servo, gains = self._servo, self._servo.pid.gains
        msg = JointControllerState(
            set_point=servo.target, process_value=servo.process_value, error=servo.error,
            time_step=period, command=servo.output, p=gains.p, i=gains.i, d=gains.d,
            i_clamp=gains.i_clamp_max, antiwindup=gains.antiwindup)
        if self.law is PositionServo:
            msg.process_value_dot = servo.handle.joint.velocity
        return convert.stamped(msg, time)


@controller("effort_controllers/JointPositionController")
class EffortPosition(ServoController):
    """rad or m, by effort."""


@controller("effort_controllers/JointVelocityController")
class EffortVelocity(ServoController):
    """rad/s or m/s, by effort."""
    law = VelocityServo


@controller("velocity_controllers/JointPositionController")
class VelocityPosition(ServoController):
    """rad or m, by velocity."""
    interface = "velocity"


@controller("effort_controllers/JointGroupPositionController")
class EffortGroupPosition(ServoController):
    """rad or m for each of `joints`, by effort; gains in `<joint>/pid`. It publishes no state."""

    def __init__(self, context: ControllerContext):
        Controller.__init__(self, context)
        self._topics = []
        joints = context.parameters.texts("joints")
        self._servos = Servos([self._open_servo(joint, f"{joint}/pid") for joint in joints],
                              command_timeout(context))
        subscribe_all(context, self._servos.commands, len(joints))

    def update(self, time: float, period: float) -> None:
        """Write the commands."""
        self._servos.update(time, period)
        for topic in self._topics:
            topic.publish(time, period)
