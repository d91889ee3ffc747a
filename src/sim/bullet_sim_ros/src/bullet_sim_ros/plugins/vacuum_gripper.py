"""libgazebo_ros_vacuum_gripper.so: services on and off; the link holds objects near it."""

from std_msgs.msg import Bool
from std_srvs.srv import Empty, EmptyResponse

from bullet_sim.mechanisms.vacuum import Vacuum, VacuumParameters
from bullet_sim_ros import names
from bullet_sim_ros.plugin_host import PluginContext, plugin


@plugin("libgazebo_ros_vacuum_gripper.so")
class VacuumGripperPlugin:
    """Publishes at each step whether something is held."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        namespace = p.namespace(missing="/", empty="/")
        self._vacuum = Vacuum(context.world, context.model.link(p.required("bodyName")),
                              VacuumParameters(p.number("maxForce", 20.0),
                                               p.number("maxDistance", 0.05),
                                               p.number("minDistance", 0.01)))
        self._on = self._held = False
        self._mailbox = context.host.mailbox
        self._topic = context.advertise(names.join(namespace, p.required("topicName")), Bool,
                                        queue_size=1)
        context.serve(names.join(namespace, "on"), Empty, lambda _request: self._switch(True))
        context.serve(names.join(namespace, "off"), Empty, lambda _request: self._switch(False))
        context.each_step(self._pull)
        context.every(0.0, lambda: self._topic.publish(Bool(self._held)),
                      self._topic.get_num_connections)

    def _switch(self, on: bool) -> EmptyResponse:
        def switch() -> None:
            self._on = on
        self._mailbox.call(switch)
        return EmptyResponse()

    def _pull(self) -> None:
        self._held = self._on and self._vacuum.update()
