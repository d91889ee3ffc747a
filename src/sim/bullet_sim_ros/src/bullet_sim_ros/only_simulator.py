"""One simulator of a name at a master: a second one ends before the first notices anything.

Twice: launch_guard.py while roslaunch reads empty_world.launch, before it sets a parameter or
starts a node; and `register` in the node itself, however it was started. As a program, for scripts
that start a course in the background: that line and exit code 1, if /gazebo may not start.
"""

import sys
import time
from pathlib import Path

import rosgraph
import rospy
from node_basics.listening import listens

from bullet_sim_ros import names
from bullet_sim_ros.already_running import (
    Sign,
    full_name,
    registering,
    sign_of_life,
    without_terminal,
)

DEFAULT_NAME = "gazebo"
RUNS_ALREADY = ("A simulator runs already on this master (%s). End it with Ctrl-C in its terminal, "
                "then type this again.")
NO_TERMINAL = ("A simulator runs already on this master (%s), without a terminal. End it and what "
               "was started with it: kill %s, then type this again.")
HANGS = ("A simulator is on this master, but does not answer (%s). End it with: killall -9 "
         "gzserver, then type this again.")
UNKNOWN = ("A simulator is registered on this master (%s), by a machine whose name this one "
           "does not know. If it has ended, type: rosnode cleanup, then type this again.")
SAYINGS = {Sign.ANSWERS: RUNS_ALREADY, Sign.HANGS: HANGS, Sign.UNKNOWN: UNKNOWN}
AGES = ((3600, "world %s, started %d h ago"), (60, "world %s, started %d min ago"),
        (1, "world %s, started %d s ago"))


def refusal(master_uri: str, name: str) -> tuple[str, ...]:
    """Why no simulator may start under this full name: a format string and its arguments; else ().

    OSError if there is no master.
    """
    sign = sign_of_life(master_uri, name)
    if sign is Sign.GONE:
        return ()
    alone = without_terminal(master_uri, name) if sign is Sign.ANSWERS else []
    if alone:
        return NO_TERMINAL, _what_runs(master_uri, name), " ".join(map(str, alone))
    return SAYINGS[sign], _what_runs(master_uri, name)


def register(world: str) -> bool:
    """Become the node, unless its name's simulator runs: then say so. `world`: its file.

    OSError if the master ends meanwhile.
    """
    name, uri = full_name(DEFAULT_NAME), rosgraph.get_master_uri()
    with registering(uri, name):
        refused = refusal(uri, name)
        if refused:
            rospy.logfatal(*refused)
            return False
        # This node publishes /clock: rospy must not wait for a /clock that this very node
        # publishes. Signals are handled here: rospy's handler would interrupt the loop while it
        # holds locks.
        rospy.init_node(DEFAULT_NAME, disable_rostime=True, disable_signals=True)
        rospy.set_param(names.RUNNING, {"world": Path(world).stem, "since": time.time()})
    rospy.rostime.set_rostime_initialized(True)
    return True


def _what_runs(master_uri: str, name: str) -> str:
    """Such as "world course, started 3 min ago"."""
    try:
        running = rosgraph.Master(name, master_uri).getParam(name + names.RUNNING.replace("~", "/"))
        age = max(0, int(time.time() - running["since"]))
        world = running["world"]
    except (rosgraph.MasterException, KeyError, TypeError):  # real Gazebo, or a deleted parameter
        return name
    unit, text = next(one for one in AGES if age >= one[0] or one[0] == 1)
    return text % (world, age // unit)


def main() -> int:
    """Print why no simulator may start, if so; returns the exit code."""
    uri = rosgraph.get_master_uri()
    refused = refusal(uri, f"/{DEFAULT_NAME}") if listens(uri) else ()
    if refused:
        print(refused[0] % refused[1:], file=sys.stderr)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
