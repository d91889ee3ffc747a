"""A launch file of the racecar as a user starts it, on a master of its own, and its end."""

import os
import socket
import time
from collections.abc import Callable
from pathlib import Path

import rosgraph
import rospy
from trial_record import Record
from trial_venue import Venue

from run_session.processes import Child, Family

STARTUP = 120.0  # s, wall


class TrialError(RuntimeError):
    """What did not happen in time, and the end of the log."""


class Session:
    """Starts it; as a context it leaves nothing behind. `record` begins with the first pose."""

    def __init__(self, venue: Venue, launch: str, out: Path, *arguments: str) -> None:
        """`arguments`: of the launch file, `name:=value`."""
        self._venue, self._out = venue, out
        self._port = _free_port()
        self._uri = os.environ["ROS_MASTER_URI"] = f"http://localhost:{self._port}"
        self._family = Family()
        self.launched = self.start(
            launch, "roslaunch", "-p", str(self._port), "racecar_description", f"{launch}.launch",
            f"world_name:={venue.world}", "gui:=false", "rviz:=false", *arguments)

    def __enter__(self) -> "Session":
        try:
            self.wait(lambda: rosgraph.is_master_online()
                      and rosgraph.Master("/trial").getParam("/use_sim_time"), "the master")
            rospy.init_node("trial", disable_signals=True)
            self.record = Record()
            self.wait(lambda: len(self.record.truth) and self.record.hears_contacts,
                      "the car and the walls' sensor")
        except BaseException:
            self._family.stop()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        rospy.signal_shutdown("the trial has ended")
        self._family.stop()

    def start(self, name: str, *command: str) -> Child:
        """A further program, its output in OUT/NAME.log."""
        environment = {**self._venue.environment, "ROS_MASTER_URI": self._uri}
        return self._family.start(name, list(command), environment, self._out / f"{name}.log")

    def end(self, child: Child) -> None:
        """Ends a program that was started here."""
        self._family.end(child)

    def wait(self, condition: Callable[[], object], what: str, limit: float = STARTUP) -> None:
        """Until it is true; `limit` in s of wall time. Raises TrialError, also if ROS has ended."""
        if not self.comes(condition, limit):
            raise TrialError(f"not within {limit:.0f} s: {what}\n{self.launched.last_lines()}")

    def comes(self, condition: Callable[[], object], limit: float) -> bool:
        """Whether it is true within `limit`, s of wall time. Raises TrialError if ROS has ended."""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            try:
                if condition():
                    return True
            except (rosgraph.MasterException, OSError):
                pass  # the master is not there yet
            if self.launched.process.poll() is not None:
                raise TrialError(f"the launch file has ended\n{self.launched.last_lines()}")
            time.sleep(0.05)
        return False


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]
