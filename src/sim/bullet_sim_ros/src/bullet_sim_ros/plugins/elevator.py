"""libgazebo_ros_elevator.so: a lift that goes to the floor whose number is sent on a topic."""

import logging
import sys
from collections.abc import Callable

from std_msgs.msg import String

from bullet_sim.mechanisms.elevator import Elevator
from bullet_sim_ros import names
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_elevator.so")
class ElevatorPlugin:
    """A call while the lift moves is ignored (Gazebo's ElevatorPlugin.cc, MoveToFloor)."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        lift, door = (context.model.joint(p.required(tag)) for tag in ("lift_joint", "door_joint"))
        self._elevator = Elevator(context.world, lift, door, p.number("floor_height", 3.0),
                                  p.number("door_wait_time", 5.0))
        self._bottom = p.number("bottom_floor", -sys.maxsize)
        self._top = p.number("top_floor", sys.maxsize)
        topic = names.join(p.namespace(missing="/", empty="/"), p.text("topic", "elevator"))
        context.subscribe(topic, String, self._take, queue_size=1)
        context.each_step(self._elevator.update)
        context.on_reset(self._elevator.reset)

    def _take(self, msg: String) -> Callable[[], None] | None:
        try:
            floor = int(msg.data)
        except ValueError:
            log.error("%s: %r is not a floor; a whole number is", self._context.describe(),
                      msg.data)
            return None
        if not self._bottom <= floor <= self._top:
            log.error("%s: there is no floor %d; there are %g to %g", self._context.describe(),
                      floor, self._bottom, self._top)
            return None
        return lambda: self._elevator.go(floor)
