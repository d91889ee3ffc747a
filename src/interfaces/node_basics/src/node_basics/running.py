"""What runs on this master, by the services that it offers."""

import rosgraph
import rospy

from node_basics.listening import listens


def simulators(service: str = "spawn_urdf_model") -> list[str]:
    """The nodes, such as /one/gazebo, that offer the simulator's service of this name."""
    return [f"{place}/gazebo" for place in offering(f"/gazebo/{service}")]


def offering(ending: str) -> list[str]:
    """The names that stand before `ending` in the services' names.

    `/gazebo` for `/gazebo/spawn_sdf_model` and the ending `/spawn_sdf_model`.

    The master still lists those of a node that was killed; nobody listens at its port.
    """
    master = rosgraph.Master(rospy.get_name())
    _, _, offered = master.getSystemState()
    return sorted(name.removesuffix(ending) for name, (node, *_) in offered
                  if name.endswith(ending) and _listens(master, node))


def _listens(master: rosgraph.Master, node: str) -> bool:
    """Whether the node answers at its XML-RPC port; at a service's port it would log a warning."""
    try:
        return listens(master.lookupNode(node))
    except (OSError, rosgraph.MasterException):
        return False
