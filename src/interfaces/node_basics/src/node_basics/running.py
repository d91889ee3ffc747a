"""What runs on this master, by the services that it offers."""

import rosgraph
import rospy

from node_basics.listening import listens


def simulators(service: str = "spawn_urdf_model") -> list[str]:
    """The nodes, such as /one/gazebo, that offer the simulator's service of this name."""
    return [f"{place}/gazebo" for place in offering(f"/gazebo/{service}")]


def offering(ending: str) -> list[str]:
    """What comes before this ending in the names of services.

    The master still lists those of a node that was killed; nobody listens at its port.
    """
    master = rosgraph.Master(rospy.get_name())
    _, _, offered = master.getSystemState()
    return sorted(name.removesuffix(ending) for name, (node, *_) in offered
                  if name.endswith(ending) and _listens(master, node))


def _listens(master: rosgraph.Master, node: str) -> bool:
    """At its XML-RPC port: of a service's, a node warns when nobody asks for anything there."""
    try:
        return listens(master.lookupNode(node))
    except (OSError, rosgraph.MasterException):
        return False
