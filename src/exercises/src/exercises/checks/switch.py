"""A service that starts and stops the turtle: /turtle_drive, std_srvs/SetBool."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool

from exercises.errors import Mistake
from exercises.finding import Finding, holds
from exercises.node import START, running

SERVICE, TOPIC = "/turtle_drive", "/turtle1/cmd_vel"
QUIET = 0.5  # s, by which messages sent before a call have arrived
PATIENCE = 5.0  # s, for the first command after it was switched on


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """true: it must drive; true again: still drive; false: stop, and stay so."""
    with running(file) as until:
        speeds: list[float] = []
        rospy.Subscriber(TOPIC, Twist, lambda msg: speeds.append(msg.linear.x), queue_size=10)
        if not until(_is_there, START):
            raise Mistake(f"{file}: offers no service {SERVICE} of type std_srvs/SetBool")
        set_drive = rospy.ServiceProxy(SERVICE, SetBool)
        for wanted in (True, True, False, False):
            try:
                success = set_drive(wanted).success
            except rospy.ServiceException as error:
                raise Mistake(f"{file}: {SERVICE} failed: {error}") from error
            until(lambda: False, QUIET)
            speeds.clear()
            drives = until(lambda: any(speeds), PATIENCE if wanted else limits["seconds"])
            yield holds(f"after {SERVICE} {str(wanted).lower()}", _words(drives), _words(wanted),
                        drives == wanted)
            yield holds(f"its answer to {str(wanted).lower()}", f"success {success}",
                        "success True", success)


def _is_there() -> bool:
    try:
        rospy.wait_for_service(SERVICE, timeout=0.1)
    except rospy.ROSException:
        return False
    return True


def _words(drives: bool) -> str:
    return "the turtle drives" if drives else "the turtle stands"
