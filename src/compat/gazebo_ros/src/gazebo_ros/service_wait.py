"""Waits for a service as rospy does, and notices sooner that it is there."""

import contextlib
import time

import rosgraph
import rospy
from node_basics.running import simulators

# s; rospy's 0.3 s would be a tenth of the time to a first image. A look costs 0.1 ms here and as
# much in the master (measured).
POLL_PERIOD = 0.02
NOTICE_AFTER = 5.0  # s without the service, then a line names the simulators that have one


def wait_for_service(service: str) -> None:
    """Returns when the service answers; rospy.ROSInterruptException at shutdown."""
    master = rosgraph.Master(rospy.get_name())
    name = rospy.resolve_name(service)
    notice_at = time.monotonic() + NOTICE_AFTER
    while not rospy.is_shutdown() and _is_missing(master, name):
        if time.monotonic() > notice_at:
            notice_at = float("inf")
            _name_others(name)
        time.sleep(POLL_PERIOD)
    rospy.wait_for_service(service)


def _name_others(service: str) -> None:
    """A warning, if simulators in other namespaces offer what nobody offers under this name."""
    with contextlib.suppress(OSError, rosgraph.MasterException):
        if others := simulators(service.rpartition("/")[2]):
            near = f"{rospy.get_namespace()}gazebo"  # of the group that this node is in, too
            advised = near if near in others else others[0]
            rospy.logwarn(f"Nobody offers {service}. A simulator runs as: {', '.join(others)} "
                          f"(spawn_model: -gazebo_namespace {advised})")


def _is_missing(master: rosgraph.Master, name: str) -> bool:
    """Whether the master knows no such service; if it cannot be asked, rospy reports that later."""
    try:
        master.lookupService(name)
    except rosgraph.MasterException:
        return True
    except OSError:
        pass
    return False
