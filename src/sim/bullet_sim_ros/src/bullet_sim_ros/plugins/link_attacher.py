"""libgazebo_ros_link_attacher.so: a world plugin whose services tie links together."""

import logging

from gazebo_ros_link_attacher.srv import Attach, AttachResponse

from bullet_sim.errors import SimulationError
from bullet_sim.physics.weld import Weld
from bullet_sim_ros import names
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")

NAMESPACE = "/link_attacher_node"
Ends = tuple[str, str, str, str]  # model, link, other model, its link


@plugin("libgazebo_ros_link_attacher.so")
class LinkAttacherPlugin:
    """Attached links keep their present pose relative to each other.

    gazebo_ros_link_attacher.cpp, attach, pulls the two origins together; it has no Reset, so that a
    reset of the world releases nothing. Nor does it here; links are then held as they were spawned.
    """

    def __init__(self, context: PluginContext):
        self._context = context
        self._held: dict[Ends, Weld] = {}
        for name, action in (("attach", self._attach), ("detach", self._detach)):
            context.serve(names.join(NAMESPACE, name), Attach, self._handler(name, action))
        context.on_close(self._release_all)

    def _handler(self, name: str, action):
        def serve(request) -> AttachResponse:
            ends = (request.model_name_1, request.link_name_1,
                    request.model_name_2, request.link_name_2)
            try:
                return AttachResponse(self._context.host.mailbox.call(lambda: action(ends)))
            except SimulationError as error:
                log.error("%s: cannot %s: %s", self._context.describe(), name, format_error(error))
                return AttachResponse(False)
        return serve

    def _attach(self, ends: Ends) -> bool:
        world = self._context.world
        first, second = (world.model(ends[at]).link(ends[at + 1]) for at in (0, 2))
        if first is second:
            raise SimulationError(f"{first.scoped_name} is one link; it takes two")
        self._detach(ends)
        self._held[ends] = second.attach(first)
        return True

    def _detach(self, ends: Ends) -> bool:
        """Whether there was anything to release (gazebo_ros_link_attacher.cpp, detach)."""
        weld = self._held.pop(ends, None)
        if weld is None:
            return False
        weld.release()
        return True

    def _release_all(self) -> None:
        while self._held:
            self._held.popitem()[1].release()
