"""The six services of controller_manager."""

import logging
from collections.abc import Callable

from controller_manager_msgs import srv
from controller_manager_msgs.msg import ControllerState, HardwareInterfaceResources

from bullet_sim_ros import names
from bullet_sim_ros.control import registry
from bullet_sim_ros.control.manager import ControllerManager
from bullet_sim_ros.control.switching import Gone, Loaded, ManagerError
from bullet_sim_ros.plugin_host import PluginContext

log = logging.getLogger("bullet_sim.control")

STRICT, BEST_EFFORT = srv.SwitchControllerRequest.STRICT, srv.SwitchControllerRequest.BEST_EFFORT
INTERFACE_NAMES = {"effort": "hardware_interface::EffortJointInterface",
                   "position": "hardware_interface::PositionJointInterface",
                   "velocity": "hardware_interface::VelocityJointInterface"}
READ_ONLY = "hardware_interface::JointStateInterface"


def offer(context: PluginContext, manager: ControllerManager, namespace: str) -> None:
    """Advertise the services below NAMESPACE/controller_manager."""
    def switch(request: srv.SwitchControllerRequest) -> None:
        if request.strictness not in (STRICT, BEST_EFFORT):
            log.warning("Controller Manager: To switch controllers you need to specify a "
                        "strictness level of controller_manager_msgs::SwitchController::STRICT "
                        "(%d) or ::BEST_EFFORT (%d). Defaulting to ::BEST_EFFORT",
                        STRICT, BEST_EFFORT)
        manager.switch(request.start_controllers, request.stop_controllers,
                       request.strictness == STRICT, request.timeout)

    def list_controllers(_request) -> srv.ListControllersResponse:
        return srv.ListControllersResponse([
            state_of(loaded, manager.state_of(loaded)) for loaded in manager.list()])

    def list_types(_request) -> srv.ListControllerTypesResponse:
        types = registry.types()
        return srv.ListControllerTypesResponse(types, [registry.BASE_CLASS] * len(types))

    handlers = {
        "list_controllers": (srv.ListControllers, list_controllers),
        "list_controller_types": (srv.ListControllerTypes, list_types),
        "load_controller": (srv.LoadController, _answer(
            lambda request: manager.load(request.name), srv.LoadControllerResponse)),
        "unload_controller": (srv.UnloadController, _answer(
            lambda request: manager.unload(request.name), srv.UnloadControllerResponse)),
        "switch_controller": (srv.SwitchController, _answer(switch, srv.SwitchControllerResponse)),
        "reload_controller_libraries": (srv.ReloadControllerLibraries, _answer(
            lambda request: manager.reload(request.force_kill),
            srv.ReloadControllerLibrariesResponse)),
    }
    for name, (kind, handler) in handlers.items():
        context.serve(names.join(namespace, f"controller_manager/{name}"), kind, handler)


def state_of(loaded: Loaded, state: str) -> ControllerState:
    """A controller as list_controllers describes it."""
    claimed: dict[str, list[str]] = {}
    for joint, handle in sorted(loaded.context.claims.items()):
        claimed.setdefault(INTERFACE_NAMES[handle.interface], []).append(joint)
    if not claimed:
        claimed[READ_ONLY] = []
    resources = [HardwareInterfaceResources(kind, joints) for kind, joints in claimed.items()]
    return ControllerState(loaded.name, state, loaded.type, resources)


def _answer(act: Callable, response: type) -> Callable:
    """A service handler that calls `act` and answers whether that worked; it logs errors."""
    def handle(request):
        try:
            act(request)
        except Gone as error:  # not an error
            log.info("%s", error)
            return response(ok=False)
        except ManagerError as error:
            log.error("%s", error)
            return response(ok=False)
        return response(ok=True)
    return handle
