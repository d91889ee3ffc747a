"""The command `spawner`: loads and starts controllers, and takes them down again when it ends."""

import argparse
import threading
import time
from collections.abc import Callable

import rospy
from std_msgs.msg import Bool

from controller_manager import configuration, diagnosis
from controller_manager.client import ManagerClient
from controller_manager.lifetime import POLL_PERIOD, live

NEEDED = ("load_controller", "switch_controller", "unload_controller")
STOP_TIMEOUT = 5.0  # s of wall time; a paused world stops nothing, and the spawner must end


def arguments() -> argparse.ArgumentParser:
    """Upstream's options."""
    parser = argparse.ArgumentParser(prog="spawner", description="Load and start controllers; "
                                     "stop and unload them when this ends.")
    parser.add_argument("controllers", metavar="controller", nargs="+",
                        help="a name, or a YAML file with controllers")
    parser.add_argument("--namespace", metavar="NS", default="",
                        help="of the controller manager and of the controllers' parameters")
    parser.add_argument("--stopped", action="store_true", help="load only")
    parser.add_argument("--wait-for", metavar="TOPIC", help="begin at a true on it (std_msgs/Bool)")
    parser.add_argument("--timeout", metavar="T", type=float, default=30.0,
                        help="s to wait for each service; 0 or less: for ever; default: 30")
    parser.add_argument("--no-timeout", action="store_true", help="the same as --timeout 0")
    parser.add_argument("--shutdown-timeout", metavar="T", help="deprecated, no effect")
    return parser


class Spawner:
    """One run of the command; `work` in the main thread, `undo` once, perhaps in another."""

    def __init__(self, options: argparse.Namespace):
        self._options = options
        self._manager = ManagerClient(options.namespace)
        self._timeout = None if options.no_timeout or options.timeout <= 0 else options.timeout
        self._mine: list[str] = []  # loaded, or asked for and not yet refused
        self._found = False
        self._ending = False

    def work(self) -> int | None:
        """None once all is up; else the exit code, which is 0 without a manager, as upstream."""
        if self._options.shutdown_timeout is not None:
            rospy.logwarn("DEPRECATION warning: --shutdown-timeout has no effect.")
        if not all(self._wait(service) for service in NEEDED):
            return 0
        self._found = True
        if self._options.wait_for:
            self._wait_for_topic(self._options.wait_for)
        try:
            names = self._names()
        except configuration.ConfigurationError as error:
            rospy.logfatal(str(error))
            return 1
        self._load(names)
        if not self._options.stopped and self._mine:
            self._start()
        return None

    def undo(self) -> None:
        """Stops and unloads what this spawner loaded."""
        self._ending = True
        if not self._found:
            return
        rospy.loginfo("Shutting down spawner. Stopping and unloading controllers...")
        try:
            self._unload(complain=rospy.logwarn if self._stop() else rospy.loginfo)
        except (rospy.ServiceException, rospy.ROSException) as error:
            rospy.loginfo(f"The controller manager has ended, its controllers with it: {error}")

    def _wait(self, service: str) -> bool:
        rospy.loginfo(f"Controller Spawner: Waiting for service {self._manager.name(service)}")
        while not self._manager.wait(service, self._timeout, rospy.logwarn):
            if rospy.get_param("/use_sim_time", False) and rospy.get_time() == 0.0:
                rospy.loginfo("Waiting for /clock to be available...")
                continue
            rospy.logwarn("Controller Spawner couldn't find the expected controller_manager "
                          "ROS interface.")
            rospy.logwarn(self._manager.absence(service))
            return False
        return True

    def _wait_for_topic(self, topic: str) -> None:
        came = threading.Event()
        subscriber = rospy.Subscriber(topic, Bool, lambda msg: came.set() if msg.data else None)
        warn_at = time.monotonic() + (self._timeout or self._options.timeout)
        warned = self._timeout is None
        while not came.wait(POLL_PERIOD) and not rospy.is_shutdown():
            if not warned and time.monotonic() > warn_at:
                warned = True
                rospy.logwarn(f'Controller Spawner hasn\'t heard anything true from its "wait for" '
                              f"topic ({subscriber.resolved_name})")
        subscriber.unregister()

    def _names(self) -> list[str]:
        return [name for word in self._options.controllers
                for name in (configuration.load(word) if configuration.is_file_name(word)
                             else [word])]

    def _load(self, names: list[str]) -> None:
        for name in names:
            if self._ending:
                return
            rospy.loginfo(f"Loading controller: {name}")
            self._mine.append(name)
            if not self._manager.load(name):
                self._mine.remove(name)
                reason = diagnosis.load_failure(self._manager, name)
                rospy.logerr(f"Failed to load {name}: {reason}")
        rospy.loginfo(f"Controller Spawner: Loaded controllers: {', '.join(self._mine)}")

    def _start(self) -> None:
        if self._ending:
            return
        names = ", ".join(self._mine)
        if self._manager.switch(start=self._mine):
            rospy.loginfo(f"Started controllers: {names}")
            return
        reason = diagnosis.switch_failure(self._manager.controllers(), self._mine, ())
        rospy.logerr(f"Failed to start controllers: {names}: {reason}")

    def _stop(self) -> bool:
        """Whether the manager stopped them; after Ctrl-C it refuses, as its world ends as well."""
        rospy.loginfo("Stopping all controllers...")
        running = [state.name for state in self._manager.controllers()
                   if state.name in self._mine and state.state == "running"]
        began = time.monotonic()
        if not running or self._manager.switch(stop=running, timeout=STOP_TIMEOUT):
            return True
        waited = time.monotonic() - began
        if waited < 0.9 * STOP_TIMEOUT:
            rospy.loginfo(f"Could not stop {', '.join(running)}: the world is ending")
            return False
        rospy.logwarn(f"Could not stop {', '.join(running)} within {waited:.0f} s: is the world "
                      "paused?")
        return True

    def _unload(self, complain: Callable[[str], None]) -> None:
        rospy.loginfo("Unloading all loaded controllers...")
        for name in reversed(self._mine):
            rospy.loginfo(f"Trying to unload {name}")
            if self._manager.unload(name):
                rospy.loginfo(f"Succeeded in unloading {name}")
            else:
                reason = diagnosis.unload_failure(self._manager, name)
                complain(f"Failed to unload {name}: {reason}")


def main() -> int:
    spawner = Spawner(arguments().parse_args(rospy.myargv()[1:]))
    try:
        return live("spawner", spawner.work, spawner.undo)
    except rospy.ServiceException as error:
        rospy.logerr(f"Controller Spawner: {error}")
        return 1
