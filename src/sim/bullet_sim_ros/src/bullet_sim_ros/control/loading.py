"""Creates the controller that parameters describe, or says what is wrong with them."""

from bullet_sim_ros.control import registry
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.switching import Loaded, ManagerError
from bullet_sim_ros.errors import format_error


def make_controller(name: str, context: ControllerContext) -> Loaded:
    """Create a controller of the parameter `type`; ManagerError if that fails."""
    kind = context.parameters.value("type", None)
    if kind is None:
        raise ManagerError(
            f"Could not load controller '{name}' because the type was not specified. Did you "
            "load the controller configuration on the parameter server (namespace: "
            f"'{context.namespace}')? Parameter {context.parameters.where('type')} is not set")
    made = registry.find(str(kind))
    if made is None:
        raise ManagerError(
            f"Could not load controller '{name}' because controller type '{kind}' does not "
            f"exist{registry.hint(str(kind)) or '.'} Use 'rosservice call "
            "controller_manager/list_controller_types' to get the available types")
    try:
        return Loaded(name, str(kind), made(context), context)
    except Exception as error:
        raise ManagerError(
            f"Initializing controller '{name}' failed: {format_error(error)}"
        ) from error
