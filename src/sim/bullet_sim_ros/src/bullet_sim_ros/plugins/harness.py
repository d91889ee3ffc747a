"""libgazebo_ros_harness.so: a model hangs on a winch until it is detached."""

import logging
from collections.abc import Callable
from xml.etree.ElementTree import Element

from std_msgs.msg import Bool, Float32

from bullet_sim.errors import PluginError
from bullet_sim.mechanisms.harness import Harness
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext, plugin

UPWARDS = (0.0, 0.0, 1.0)

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_harness.so")
class HarnessPlugin:
    """The winch keeps its speed without the PIDs of the file, and the model does not swing."""

    def __init__(self, context: PluginContext):
        self._context = context
        element = context.description.element
        joints = {joint.get("name", ""): joint for joint in element.findall("joint")}
        if not joints:
            raise PluginError("it needs a <joint>")
        p = context.parameters
        winches = [winch.text("joint") for winch in p.groups("winch")]
        held = self._joint(joints, "detach", p.text("detach"))
        winch = self._joint(joints, "winch/joint", next(iter(winches), ""))
        link = context.model.link((held.findtext("child") or "").strip())
        self._harness = Harness(context.world, link, self._axis(winch))
        topics = names.join(f"/{context.model.name}", "harness")
        context.subscribe(names.join(topics, "velocity"), Float32, self._take_speed, queue_size=1)
        context.subscribe(names.join(topics, "detach"), Bool,
                          lambda msg: self._harness.detach if msg.data else None, queue_size=1)
        context.each_step(self._harness.update)
        context.on_close(self._harness.detach)

    def _joint(self, joints: dict[str, Element], path: str, name: str) -> Element:
        """The joint that a tag names, else the first one."""
        if name in joints:
            return joints[name]
        first = next(iter(joints))
        log.warning("%s: <%s> is %r; there are: %s; %s is used", self._context.describe(), path,
                    name, ", ".join(filter(None, joints)) or "joints without a name",
                    first or "the first joint")
        return joints[first]

    def _axis(self, joint: Element) -> tuple[float, ...]:
        axis = joint.find("axis")
        if axis is None:
            return UPWARDS
        return self._context.parameters.inside(axis, "axis").numbers("xyz", UPWARDS)

    def _take_speed(self, msg: Float32) -> Callable[[], None] | None:
        if not abs(msg.data) <= convert.LARGEST:
            log.warning("%s: a speed that is not finite is ignored", self._context.describe())
            return None
        return lambda: self._harness.command(msg.data)
