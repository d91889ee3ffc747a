"""Finds the page that shows this master already, so that a second one does not end it.

As a program, for scripts/viewer.sh: prints the line that says where it is, if there is one.
"""

import http.client
import json
import sys
import time
from dataclasses import asdict
from typing import Any
from urllib.parse import urlsplit

import rosgraph
import rospy

from bullet_sim_ros.already_running import (
    ANSWER_TIME,
    LOOK_PERIOD,
    Sign,
    full_name,
    sign_of_life,
)
from sim_viewer.options import Options
from sim_viewer.urls import ABOUT, local_url

RUNS_ALREADY = "A page runs already: %s"
LACKS = ("A page runs already: %s It was started without %s: end it with Ctrl-C in its terminal, "
         "then type this again.")
HANGS = ("A page runs already: %s It does not answer: end it with Ctrl-C in its terminal, then "
         "type this again.")
TAKEN = "viewer: port %s is taken, so it is %s"
OTHER_MASTER = "viewer: port %s has a page that shows the master %s, so this one is at %s"
START_TIME = 5.0  # s, wall, from a page's registration until it has set its address
WISHES = ("control", "rviz", "address")  # options that a running page may lack


def running_page(name: str, rviz: str) -> tuple[str, ...]:
    """A format string and its arguments, if a page of this node name shows this master; else ().

    RUNS_ALREADY if that page has all that is wished for here. `rviz`: a .rviz file, or "". Without
    a master, none is there.
    """
    uri, node = rosgraph.get_master_uri(), full_name(name)
    if not rosgraph.is_master_online(uri):
        return ()
    wished = _wished(uri, node) | ({"rviz": rviz} if rviz else {})
    sign = sign_of_life(uri, node)
    if sign in (Sign.GONE, Sign.UNKNOWN):  # the latter: of a container, say, that was made anew
        # A page whose master has ended keeps its address, and changes to the next master by itself.
        address = local_url(str(wished["address"]), wished["port"])
        told = ask(address)
        if (told.get("node"), told.get("master")) != (node, uri):
            return ()
    else:
        address = _url(uri, node)
        if sign is Sign.HANGS:
            return HANGS, address
        told = ask(address)
    lacking = [f"{wish}:={str(wished[wish]).lower() if wish == 'control' else wished[wish]}"
               for wish in WISHES if wish in told
               and wished[wish] not in (told[wish], getattr(Options, wish))]
    return (LACKS, address, " ".join(lacking)) if lacking else (RUNS_ALREADY, address)


def why_another_port(options: Options, port: int) -> str:
    """A line that says who holds the port asked for, and that this page is at `port` instead."""
    told = ask(local_url(options.address, options.port))
    if "master" in told:
        return OTHER_MASTER % (options.port, told["master"], port)
    return TAKEN % (options.port, port)


def _url(master_uri: str, node: str) -> str:
    """The running page's address; one that starts may set it a moment later. "" if it does not."""
    until = time.monotonic() + START_TIME
    while not (url := _parameter(master_uri, f"{node}/url", "")) and time.monotonic() < until:
        time.sleep(LOOK_PERIOD)
    return url


def _wished(master_uri: str, node: str) -> dict[str, Any]:
    """Options as read_options will find them: of the command line, of the master, the defaults."""
    given = _parameter(master_uri, node, {})
    return {**asdict(Options()), **(given if isinstance(given, dict) else {}),
            **rospy.client.load_command_line_node_params(sys.argv)}


def _parameter(master_uri: str, name: str, default: Any) -> Any:
    try:
        return rosgraph.Master(name, master_uri).getParam(name)
    except rosgraph.MasterException:
        return default


def ask(address: str) -> dict[str, Any]:
    """What the server at this address says about itself; {} if it does not answer as a page."""
    try:
        place = urlsplit(address)
        connection = http.client.HTTPConnection(place.hostname or "", place.port,
                                                timeout=ANSWER_TIME)
    except (ValueError, http.client.HTTPException):  # no port, which read_options will say
        return {}
    try:
        connection.request("GET", ABOUT)
        told = json.loads(connection.getresponse().read())
    except (OSError, http.client.HTTPException, ValueError):
        return {}
    finally:
        connection.close()
    return told if isinstance(told, dict) else {}


if __name__ == "__main__":
    found = running_page("sim_viewer", "")
    print(found[0] % found[1:] if found else "")
