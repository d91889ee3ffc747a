"""Starts roscore and the launch file, and notices when one of their processes dies."""

from __future__ import annotations

import os
import re
import shutil
import signal
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from bullet_sim_ros.already_running import may_simulate
from run_session.failure import RunError
from run_session.files import check_space
from run_session.master import is_up, own_port, take_turn
from run_session.processes import INTERRUPT_TIME, Child, Family

LOOPBACK = "127.0.0.1"  # not localhost: that is ::1 too, where another program may listen
ROSCORE_TIME = 300.0  # s, wall; an emulated ARM processor takes more than 20
LOOK_PERIOD = 0.05  # s, wall
ROSCORE_LOG = "roscore.log"  # in the folder of each run's logs
MAY_FINISH = ("spawn",)  # nodes of these names may end with exit code 0
DIED = re.compile(r"\[([\w/.-]+)\] process has died \[(?:pid \d+, )?exit code (-?\d+)")
REQUIRED = re.compile(r"REQUIRED process \[([\w/.-]+)\] has died!")
EXIT_CODE = re.compile(r"process has died \[(?:pid \d+, )?exit code (-?\d+)")
FINISHED = re.compile(r"\[([\w/.-]+)\] process has finished cleanly")


class Launched:
    """roscore and roslaunch of one run, with the log files they write."""

    def __init__(
        self, family: Family, log_folder: Path, follower: str = "", vehicle: str = "car",
        alone: bool = False, environment: Mapping[str, str] = MappingProxyType({}),
        joined: bool = False, master: str = ""
    ):
        """`alone`: in a network namespace of its own, where no other run chooses a port.

        `environment`: further variables for all programs. `joined`: by other terminals.
        `master`: the URI of one that runs already, and goes on."""
        self._family, self._follower, self._vehicle = family, follower, vehicle
        self.log_folder = log_folder
        _remove_logs(self.log_folder)
        self.log_folder.mkdir(parents=True)
        # Held from choosing a port until roscore listens, so that no other run takes the same one;
        # if others join this master, until it has a simulator, which make viewer then finds.
        self._joined = joined
        turn = log_folder if alone or master else Path(tempfile.gettempdir())
        self._turn = take_turn(turn / f"course_run-{os.getuid()}.lock")
        self.port, self.why_not_callers = own_port(joined)  # the caller's master
        self._runs = bool(master)
        self.master_uri = master or f"http://{LOOPBACK if alone else 'localhost'}:{self.port}"
        self._environment = dict(
            os.environ,
            ROS_MASTER_URI=self.master_uri,
            ROS_LOG_DIR=str(self.log_folder),
            ROS_HOME=str(self.log_folder),  # not ~/.ros, which may be on a full disk
            PYTHONUNBUFFERED="1",
            LANGUAGE="en",  # lines of the logs are looked for; what is shown of them is translated
            **environment,
        )
        self._children: list[Child] = []
        self._said: list[str] = []  # output lines of all children, as `check` has read them
        self._time: float | None = None  # s, simulated, at the last `check_time`
        self._since = 0.0  # s, wall, since when simulated time has had this value
        self._required: dict[str, str] = {}  # child's name -> required process just reported dead

    def start_roscore(self) -> None:
        """Start roscore and wait until it is up; this process's nodes then use it."""
        for name in ("ROS_MASTER_URI", "ROS_HOME"):
            os.environ[name] = self._environment[name]
        if not self._runs:
            self.start(Path(ROSCORE_LOG).stem, ["roscore", "-p", str(self.port)])
        self.wait_for("roscore", lambda: is_up(self.master_uri), ROSCORE_TIME)
        if not self._joined:
            self._turn.close()

    def start(self, name: str, command: list[str]) -> Child:
        """Start one more program of this run; its output goes to NAME.log."""
        log = self.log_folder / f"{name}.log"
        try:
            self._children.append(self._family.start(name, command, self._environment, log))
        except OSError as error:
            raise RunError(f"{command[0]} cannot be started: {error.strerror}") from error
        return self._children[-1]

    def run(self, name: str, command: list[str], limit: float) -> None:
        """Run one program to its end; RunError unless it exits with 0 within `limit`, s."""
        child = self.start(name, command)
        self._children.remove(child)
        until = time.monotonic() + limit
        while child.process.poll() is None and time.monotonic() < until:
            self.check(None)
            time.sleep(LOOK_PERIOD)
        code = child.process.poll()
        if code != 0:
            how = f"did not end within {limit:.0f} s" if code is None else describe_exit(code)
            raise RunError(f"{name}: {how}; log: {child.log}", child.last_lines())

    def wait_for(
        self,
        what: str | Callable[[], str],
        condition: Callable[[], object],
        limit: float,
        status: Callable[[str], None] = lambda _: None,
        pause: float = LOOK_PERIOD,
    ) -> object:
        """The condition's value once it is true; RunError if that takes longer than `limit`, s.

        `what` names what is awaited, and `status` shows it meanwhile. The condition is checked
        every `pause` s, wall; 0: it waits by itself.
        """
        until = time.monotonic() + limit
        while not (value := condition()):
            self.check(None)
            missing = what() if callable(what) else what
            status(f"waiting for {missing}")
            if time.monotonic() > until:
                raise RunError(f"{missing} was not there within {limit:.0f} s", self.tail())
            time.sleep(pause)
        return value

    def end(self, child: Child, limit: float = 2 * INTERRUPT_TIME) -> None:
        """End one program, by force after `limit` (s, wall); its end is then not a failure."""
        self._children.remove(child)
        self._family.end(child, limit)

    def check(self, sim_time: float | None) -> None:
        """RunError if a process that the run needs has died, OSError if the disk is full, too."""
        if not self._turn.closed and may_simulate(self.master_uri):
            self._turn.close()
        when = f"before the {self._vehicle} drove"
        if sim_time is not None:
            when = f"at simulated time {sim_time:.1f} s"
        for child in self._children:
            for line in child.new_lines():
                self._said.append(line)
                death = self._death_in(child, line)
                if death:
                    check_space(self.log_folder)
                    raise RunError(f"{death} {when}; log: {child.log}", self.tail())
        for child in self._children:
            code = child.process.poll()
            if code is not None:
                check_space(self.log_folder)
                raise RunError(
                    f"{child.name} ended ({describe_exit(code)}) {when}; log: {child.log}",
                    self.tail(),
                )

    def check_time(self, now: float, limit: float) -> None:
        """`check`; and RunError if simulated time, s, has stood still for more than `limit`, s."""
        self.check(now)
        if now != self._time:
            self._time, self._since = now, time.monotonic()
        still = time.monotonic() - self._since
        if still > limit:
            raise RunError(f"simulated time has stood still at {now:.1f} s for {still:.0f} s:"
                           " the simulator is paused or hangs", self.tail())

    def count_said(self, text: str) -> int:
        """How many of the lines that `check` has read contain this text."""
        return sum(text in line for line in self._said)

    def tail(self) -> str:
        """The last lines of the launch's output."""
        return self._children[-1].last_lines()

    def _death_in(self, child: Child, line: str) -> str | None:
        """What a line of roslaunch's output says about a process that ended, in our words."""
        died, required, code = DIED.search(line), REQUIRED.search(line), EXIT_CODE.search(line)
        if died:
            return f"{self._role(died[1])} died ({describe_exit(int(died[2]))})"
        if required:  # its exit code follows on the next line
            self._required[child.name] = required[1]
            return None
        name = self._required.pop(child.name, None)
        if name:
            how = describe_exit(int(code[1])) if code else "exit code 0"
            return f"{self._role(name)} died ({how})"
        finished = FINISHED.search(line)
        if finished and not any(word in finished[1] for word in MAY_FINISH):
            return f"{self._role(finished[1])} ended by itself (exit code 0)"
        return None

    def _role(self, process: str) -> str:
        if process.startswith("gazebo"):
            return f"the simulator (process {process})"
        if process in ("master", "rosout-1"):
            return f"roscore (process {process})"
        driver = Path(self._follower).stem
        if driver and ("follower" in process or process.startswith(driver)):
            return f"the follower {self._follower} (process {process})"
        return f"process {process}"


def _remove_logs(folder: Path) -> None:
    """Remove the previous run's logs; RunError for a folder that no run wrote."""
    if not folder.exists():
        return
    if not folder.is_dir() or (any(folder.iterdir()) and not (folder / ROSCORE_LOG).exists()):
        raise RunError(f"{folder} is not a folder of logs that a run wrote: move it, or name"
                       " another folder for results with --out (make mark: OUT=)")
    shutil.rmtree(folder)


def describe_exit(code: int) -> str:
    """An exit code in words; negative codes are signals."""
    if code >= 0:
        return f"exit code {code}"
    try:
        return f"killed by signal {-code}, {signal.Signals(-code).name}"
    except ValueError:
        return f"killed by signal {-code}"
