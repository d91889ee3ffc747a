"""joint_state_controller/JointStateController: all joints' states, on the robot's joint_states."""

from sensor_msgs.msg import JointState

from bullet_sim.control.rate import Rate
from bullet_sim.errors import PluginError
from bullet_sim_ros import convert, names
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.registry import Controller, controller


@controller("joint_state_controller/JointStateController")
class JointStateController(Controller):
    """Publishes joints in alphabetical order, then the extra ones, at `publish_rate`."""

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        parameters = context.parameters
        if not parameters.has("publish_rate"):
            raise PluginError("Parameter 'publish_rate' not set "
                              f"(looked for {parameters.where('publish_rate')})")
        self._rate_hz = parameters.number("publish_rate")
        wanted = parameters.texts("joints") if parameters.has("joints") else context.joints
        self._joints = [context.joint(name) for name in sorted(wanted)]
        self._names = [joint.name for joint in self._joints]
        self._extra = [_extra(context, item) for item in parameters.value("extra_joints", [])]
        self._names += [extra[0] for extra in self._extra]
        topic = names.join(context.manager_namespace, "joint_states")
        self._publisher = context.advertise(topic, JointState, queue_size=4)
        self.start(context.world_time())

    def start(self, time: float) -> None:
        """Publish at the first update. SimulationError if the rate is impossible."""
        self._pace = Rate(self._rate_hz)

    def update(self, time: float, period: float) -> None:
        """Publish if it is due and there are subscribers."""
        if self._pace.due(time) and self._publisher.get_num_connections():
            self._publisher.publish(self._message(time))

    def _message(self, time: float) -> JointState:
        joints, extra = self._joints, self._extra
        msg = JointState(
            name=self._names,
            position=[joint.position for joint in joints] + [row[1] for row in extra],
            velocity=[joint.velocity for joint in joints] + [row[2] for row in extra],
            effort=[joint.effort for joint in joints] + [row[3] for row in extra])
        return convert.stamped(msg, time)


def _extra(context: ControllerContext, item) -> tuple[str, float, float, float]:
    """Name, position, velocity and effort of a joint that is not simulated."""
    try:
        values = [float(item.get(key, 0.0)) for key in ("position", "velocity", "effort")]
        return (str(item["name"]), *values)
    except (AttributeError, KeyError, TypeError, ValueError):
        raise PluginError(f"parameter {context.parameters.where('extra_joints')} has {item!r}; an "
                          "entry has a name, and if wanted position, velocity, effort") from None
