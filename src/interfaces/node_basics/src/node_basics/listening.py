"""Whether a ROS master or a node listens at its URI, and to wait for a master."""

import re
import socket
import sys
import time
from urllib.parse import urlsplit

ANSWER_TIME = 2.0  # s, wall, to connect
LOOK_AGAIN = 0.2  # s, wall
URI = re.compile(r"http://(?:[^/:]+|\[[\da-fA-F:.]+\]):([1-9]\d{0,4})/?")
MOST = 65535  # of ports
USUAL_PORT = 11311  # of roscore, if not told otherwise
WRONG = "ROS_MASTER_URI is %s, and must be as http://localhost:11311"


def fault_of(uri: str) -> str:
    """What is wrong with a master's URI, in a line; empty: nothing."""
    found = URI.fullmatch(uri)
    return "" if found and int(found[1]) <= MOST else WRONG % uri


def roscore(uri: str) -> str:
    """The command that starts a master which is found at this URI."""
    port = urlsplit(uri).port
    return "roscore" if port == USUAL_PORT else f"roscore -p {port}"


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
