"""The services of one controller manager, as Python calls."""

from collections.abc import Callable, Sequence

import rospy
from controller_manager_msgs.msg import ControllerState
from controller_manager_msgs.srv import (
    ListControllers,
    ListControllerTypes,
    LoadController,
    ReloadControllerLibraries,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from node_basics.running import offering, simulators

KINDS = {
    "list_controllers": ListControllers,
    "list_controller_types": ListControllerTypes,
    "load_controller": LoadController,
    "reload_controller_libraries": ReloadControllerLibraries,
    "switch_controller": SwitchController,
    "unload_controller": UnloadController,
}
BEST_EFFORT = SwitchControllerRequest.BEST_EFFORT
STRICT = SwitchControllerRequest.STRICT
NOTICE_AFTER = 5.0  # s of wall time without a service, then a line says what there is instead


class ManagerClient:
    """Calls raise rospy.ServiceException where the manager is gone or breaks."""

    def __init__(self, namespace: str = ""):
        """A namespace without a leading slash, and none, lie below this node's own."""
        self._prefix = namespace.rstrip("/") + "/" if namespace else ""

    @property
    def namespace(self) -> str:
        """Absolute, where the manager looks for its controllers' parameters."""
        return rospy.resolve_name(f"{self._prefix}controller_manager").rsplit("/", 1)[0] or "/"

    def name(self, service: str) -> str:
        return f"{self._prefix}controller_manager/{service}"

    def wait(self, service: str, timeout: float | None, notice: Callable[[str], None]) -> bool:
        """Whether the service is there within `timeout` s of wall time (None: for ever).

        A wait that takes long is explained once, by `notice`.
        """
        first = NOTICE_AFTER if timeout is None else min(timeout, NOTICE_AFTER)
        if self._comes(service, first):
            return True
        if timeout is not None and timeout <= NOTICE_AFTER:
            return False
        notice(self.absence(service))
        return self._comes(service, None if timeout is None else timeout - first)

    def absence(self, service: str) -> str:
        """Why the service is not there, as the master has it."""
        return absence(rospy.resolve_name(self.name(service)), managers(), simulators())

    def _comes(self, service: str, timeout: float | None) -> bool:
        try:
            rospy.wait_for_service(self.name(service), timeout)
        except rospy.ROSInterruptException:
            raise
        except rospy.ROSException:
            return False
        return True

    def _call(self, service: str, *request):
        return rospy.ServiceProxy(self.name(service), KINDS[service])(*request)

    def controllers(self) -> list[ControllerState]:
        return self._call("list_controllers").controller

    def types(self) -> list[str]:
        return self._call("list_controller_types").types

    def load(self, name: str) -> bool:
        return self._call("load_controller", name).ok

    def unload(self, name: str) -> bool:
        return self._call("unload_controller", name).ok

    def switch(self, start: Sequence[str] = (), stop: Sequence[str] = (), strictness: int = STRICT,
               timeout: float = 0.0) -> bool:
        """With timeout 0 (s, wall time) it returns when the switch is done, so not while paused."""
        return self._call("switch_controller", list(start), list(stop), strictness, False,
                          timeout).ok

    def reload(self, force_kill: bool) -> bool:
        return self._call("reload_controller_libraries", force_kill).ok


def managers() -> list[str]:
    """The namespaces in which some manager offers its services."""
    return [name or "/" for name in offering("/controller_manager/list_controllers")]


def absence(service: str, namespaces: list[str], worlds: list[str]) -> str:
    """Why nothing answers under a manager's service name, and what to type next.

    Given the namespaces with a manager, and the simulators.
    """
    own = service.rpartition("/controller_manager/")[0] or "/"
    if own in namespaces:
        return f"Nobody offers {service} yet: the controller manager in {own} is starting"
    if namespaces:
        there = ", ".join(namespaces)
        return (f"Nobody offers {service}. A controller manager answers in: {there} "
                f"(spawner: --namespace={namespaces[0]}; other tools: "
                f"ROS_NAMESPACE={namespaces[0]} before rosrun)")
    if worlds:
        return (f"Nobody offers {service}, and there is no controller manager in any namespace. "
                f"A simulator runs as: {', '.join(worlds)}. Has the robot come into its world "
                f"(rosservice call {worlds[0]}/get_world_properties), and has the robot's URDF "
                "the plugin libgazebo_ros_control.so?")
    return (f"Nobody offers {service}, and there is no controller manager in any namespace: is the "
            "simulator running, and has the robot's URDF the plugin libgazebo_ros_control.so?")
