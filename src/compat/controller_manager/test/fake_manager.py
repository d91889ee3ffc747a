"""A controller manager with a table of states, in upstream's manner, and no joints behind it."""

import threading

import rospy
from controller_manager.client import KINDS
from controller_manager_msgs.msg import ControllerState, HardwareInterfaceResources
from controller_manager_msgs.srv import (
    ListControllersResponse,
    ListControllerTypesResponse,
    LoadControllerResponse,
    ReloadControllerLibrariesResponse,
    SwitchControllerRequest,
    SwitchControllerResponse,
    UnloadControllerResponse,
)

TYPE = "effort_controllers/JointEffortController"
INTERFACE = "hardware_interface::EffortJointInterface"


class FakeManager:
    """Controllers need a type and claim the joint in their parameters; `switches` are kept."""

    def __init__(self, namespace):
        self.namespace = namespace.rstrip("/")
        self.table = {}  # name: ControllerState
        self.switches = []  # requests
        self.unpaused = threading.Event()  # while it is cleared no switch is done
        self.unpaused.set()
        self._one_request = threading.Lock()  # upstream answers one at a time
        self._services = [
            rospy.Service(f"{self.namespace}/controller_manager/{name}", kind, self._alone(name))
            for name, kind in KINDS.items()]

    def _alone(self, name):
        def answer(request):
            with self._one_request:
                return getattr(self, name)(request)

        return answer

    def states(self):
        return {name: row.state for name, row in self.table.items()}

    def configure(self, **joints):
        """Sets the parameters of controllers, each with its joint."""
        for name, joint in joints.items():
            rospy.set_param(f"{self.namespace}/{name}", {"type": TYPE, "joint": joint})

    def reset(self):
        self.table.clear()
        self.switches.clear()
        self.unpaused.set()

    def close(self):
        for service in self._services:
            service.shutdown()

    def list_controllers(self, _):
        return ListControllersResponse(list(self.table.values()))

    def list_controller_types(self, _):
        return ListControllerTypesResponse([TYPE], ["controller_interface::ControllerBase"])

    def load_controller(self, request):
        place = f"{self.namespace}/{request.name}"
        if request.name in self.table or rospy.get_param(f"{place}/type", None) != TYPE:
            return LoadControllerResponse(False)
        joint = rospy.get_param(f"{place}/joint")
        self.table[request.name] = ControllerState(
            request.name, "initialized", TYPE, [HardwareInterfaceResources(INTERFACE, [joint])])
        return LoadControllerResponse(True)

    def unload_controller(self, request):
        if self.states().get(request.name, "running") == "running":
            return UnloadControllerResponse(False)
        del self.table[request.name]
        return UnloadControllerResponse(True)

    def reload_controller_libraries(self, request):
        if request.force_kill:
            self.table.clear()
        return ReloadControllerLibrariesResponse(not self.table)

    def switch_controller(self, request):
        self.switches.append(request)
        if not self.unpaused.wait(request.timeout or None):
            return SwitchControllerResponse(False)
        states = self.states()
        running = {name for name, state in states.items() if state == "running"}
        start = [n for n in request.start_controllers if n in states and n not in running]
        stop = [n for n in request.stop_controllers if n in running]
        whole = (start, stop) == (request.start_controllers, request.stop_controllers)
        after = (running - set(stop)) | set(start)
        joints = [r for n in after for c in self.table[n].claimed_resources for r in c.resources]
        if (request.strictness == SwitchControllerRequest.STRICT and not whole) or (
                len(joints) > len(set(joints))):
            return SwitchControllerResponse(False)
        for name in stop:
            self.table[name].state = "stopped"
        for name in start:
            self.table[name].state = "running"
        return SwitchControllerResponse(True)
