"""Which simulators run on this master, by the services that they offer."""

import socket
from urllib.parse import urlsplit

import rosgraph
import rospy

ANSWER_TIME = 1.0  # s, wall, to connect


def simulators(service: str) -> list[str]:
    """The nodes, such as /one/gazebo, that offer the service of this name.

    The master still lists one that was killed; nobody listens at its port.
    """
    ending = f"/gazebo/{service}"
    master = rosgraph.Master(rospy.get_name())
    _, _, offered = master.getSystemState()
    return sorted(name.removesuffix(f"/{service}") for name, _ in offered
                  if name.endswith(ending) and _listens(master, name))


def _listens(master: rosgraph.Master, service: str) -> bool:
    try:
        place = urlsplit(master.lookupService(service))
        socket.create_connection((place.hostname, place.port), ANSWER_TIME).close()
    except (OSError, ValueError, rosgraph.MasterException):
        return False
    return True
