"""Whether a ROS master or a node listens at its URI, and to wait for a master."""

import socket
import sys
import time
from urllib.parse import urlsplit

ANSWER_TIME = 2.0  # s, wall, to connect
LOOK_AGAIN = 0.2  # s, wall


def listens(uri: str) -> bool:
    """Whether something listens at a URI; False, too, if it is none."""
    try:
        place = urlsplit(uri)
        socket.create_connection((place.hostname, place.port), ANSWER_TIME).close()
    except (OSError, TypeError, ValueError):  # the latter two: it is no URI
        return False
    return True


def wait_for_master(uri: str, line: str) -> None:
    """If no master listens, print the line, and wait for one."""
    if listens(uri):
        return
    print(line, file=sys.stderr, flush=True)
    while not listens(uri):
        time.sleep(LOOK_AGAIN)
