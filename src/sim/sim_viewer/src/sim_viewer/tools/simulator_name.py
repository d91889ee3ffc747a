"""Which node is the simulator: /gazebo, or one in another namespace."""

from sim_viewer.tools import names
from sim_viewer.tools.master import SystemState


def simulator_name(state: SystemState) -> str:
    """The node that can be paused; /gazebo if there is none or it is one of several."""
    found = sorted(service.removesuffix(names.PAUSE) for service in state.services
                   if service.endswith(names.PAUSE))
    return names.GAZEBO if names.GAZEBO in found or not found else found[0]
