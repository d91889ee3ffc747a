"""The command `unspawner`: keeps controllers stopped until it ends, then starts them again."""

import sys
import time

import rospy

from controller_manager.client import BEST_EFFORT, ManagerClient
from controller_manager.lifetime import live

CHECK_PERIOD = 3.0  # s of wall time, upstream's
RESTART_TIMEOUT = 5.0  # s of wall time; in a paused world nothing starts, and this must end
USAGE = """unspawner NAME...

    Stops controllers, and starts those that ran again when it is ended."""


class Unspawner:
    """One run of the command."""

    def __init__(self, names: list[str]):
        self._names = names
        self._manager = ManagerClient()
        self._inhibited: dict[str, None] = {}  # in the order in which they were stopped

    def work(self) -> None:
        for service in ("switch_controller", "list_controllers"):
            self._manager.wait(service, None, rospy.logwarn)
        self._name_unknown()
        while not rospy.is_shutdown():
            self._inhibit()
            next_check = time.monotonic() + CHECK_PERIOD
            while time.monotonic() < next_check and not rospy.is_shutdown():
                rospy.rostime.wallsleep(0.1)

    def undo(self) -> None:
        """Starts what was stopped."""
        if not self._inhibited:
            return
        try:
            self._manager.switch(start=list(self._inhibited), strictness=BEST_EFFORT,
                                 timeout=RESTART_TIMEOUT)
        except rospy.ServiceException as error:
            rospy.logwarn(f"unspawner could not start {', '.join(self._inhibited)} again: {error}")

    def _name_unknown(self) -> None:
        loaded = [state.name for state in self._manager.controllers()]
        for name in self._names:
            if name not in loaded:
                rospy.logwarn(f"{name} is not loaded (yet); loaded: {', '.join(loaded) or 'none'}")

    def _inhibit(self) -> None:
        running = [state.name for state in self._manager.controllers()
                   if state.name in self._names and state.state == "running"]
        if running:
            rospy.loginfo(f"Inhibiting controllers: {', '.join(running)}")
            self._inhibited.update(dict.fromkeys(running))
            self._manager.switch(stop=running, strictness=BEST_EFFORT)


def main() -> int:
    """1 for bad words, and for help as upstream."""
    names = rospy.myargv()[1:]
    if not names or names[0] in ("-h", "--help"):
        print(USAGE, file=sys.stderr)
        return 1
    unspawner = Unspawner(names)
    try:
        return live("unspawner", unspawner.work, unspawner.undo)
    except rospy.ServiceException as error:
        rospy.logerr(f"unspawner: {error}")
        return 1
