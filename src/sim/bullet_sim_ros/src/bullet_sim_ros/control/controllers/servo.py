"""Controllers with a PID: position and velocity by effort, position by velocity."""

from control_msgs.msg import JointControllerState

from bullet_sim.control.controllers.servo import TYPES, PositionServo, Servo, Servos
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.controllers.command_topic import command_timeout, subscribe
from bullet_sim_ros.control.pid import PidTopic, open_pid
from bullet_sim_ros.control.registry import Controller, controller

STATE_EVERY = 10  # updates


@controller(*TYPES)
class ServoController(Controller):
    """Reads `joint` and `pid/...`; publishes target, value and command on the topic `state`.

    A group reads `joints` and `<joint>/pid/...` and publishes no state.
    """

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        p = context.parameters
        self._interface, self._law, group = TYPES[p.text("type")]
        self._topics: list[PidTopic] = []
        joints = p.texts("joints") if group else [p.text("joint")]
        self._servos = Servos(
            [self._open_servo(joint, f"{joint}/pid" if group else "pid") for joint in joints],
            command_timeout(context))
        self._state = None if group else context.advertise(
            "state", JointControllerState, queue_size=1)
        self._updates = 0
        subscribe(context, self._servos.commands, len(joints), group)

    def _open_servo(self, joint: str, group: str) -> Servo:
        context = self.context
        handle = context.claim(self._interface, joint)
        if self._law is PositionServo:
            context.robot.limits(joint)  # a joint that the URDF does not have is an error
        pid = open_pid(context, group)
        if context.parameters.flag(f"{group}/publish_state", False):
            self._topics.append(PidTopic(context, pid, group))
        return self._law(handle, pid)

    def start(self, time: float) -> None:
        """Hold the joint until a command comes."""
        self._servos.start()
        self._updates = 0

    def update(self, time: float, period: float) -> None:
        """Write the command; publish the state every tenth time."""
        self._servos.update(time, period)
        if self._state and self._updates % STATE_EVERY == 0 and self._state.get_num_connections():
            self._state.publish(self._message(time, period))
        self._updates += 1
        for topic in self._topics:
            topic.publish(time, period)

    def _message(self, time: float, period: float) -> JointControllerState:
        servo = self._servos.servos[0]
        gains = servo.pid.gains
        msg = JointControllerState(
            set_point=servo.target, process_value=servo.process_value, error=servo.error,
            time_step=period, command=servo.output, p=gains.p, i=gains.i, d=gains.d,
            i_clamp=gains.i_clamp_max, antiwindup=gains.antiwindup)
        if self._law is PositionServo:
            msg.process_value_dot = servo.handle.joint.velocity
        return convert.stamped(msg, time)
