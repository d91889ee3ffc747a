"""Which simulators run on this master, by the services that they offer."""

import rosgraph
import rospy


def simulators(service: str) -> list[str]:
    """The nodes, such as /one/gazebo, that offer the service of this name, as the master has it."""
    ending = f"/gazebo/{service}"
    _, _, offered = rosgraph.Master(rospy.get_name()).getSystemState()
    return sorted(name.removesuffix(f"/{service}") for name, _ in offered
                  if name.endswith(ending))
