"""roscore on a port of its own, launch files and probes below it; nothing of it is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from run_session.failure import RunError
from run_session.launch import describe_exit
from run_session.master import free_port, is_up
from run_session.processes import Child, Family
from sim_bench.figures import Figure, figure
from sim_bench.settings import Settings

POLL = 0.02  # s, wall
MASTER_LIMIT, START_LIMIT, END_LIMIT = 20.0, 60.0, 10.0  # s, wall
PROBES = "sim_bench.probes"
PERCENT = "% of a core"
LEAST_CPU = 0.5  # % of a core; who uses less is left out


class RosRun:
    """One ROS master's worth of programs. Services are called from here without a node."""

    def __init__(self, family: Family, folder: Path):
        self._family = family
        self.folder = folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.port = free_port(0)
        os.environ["ROS_MASTER_URI"] = self.master_uri = f"http://localhost:{self.port}"
        self._environment = dict(
            os.environ, ROS_LOG_DIR=str(folder / "ros"), PYTHONUNBUFFERED="1"
        )
        self._children: list[Child] = []

    def start_roscore(self) -> None:
        """Returns when it is up."""
        self.start("roscore", ["roscore", "-p", str(self.port)])
        self.wait(lambda: is_up(self.master_uri), MASTER_LIMIT, "roscore")

    def launch(self, package: str, file: str, *arguments: str) -> Child:
        """roslaunch; it starts a master on our port if there is none."""
        name = f"roslaunch-{len(self._children)}"
        return self.start(name, ["roslaunch", "-p", str(self.port), package, file, *arguments])

    def probe(self, name: str, *arguments: str) -> Child:
        """One of the nodes in `probes`."""
        return self.start(name, [sys.executable, "-P", "-m", f"{PROBES}.{name}", *arguments])

    def start(self, name: str, command: list[str]) -> Child:
        """Any program of this run; its output goes to NAME.log."""
        log = self.folder / f"{name}.log"
        try:
            self._children.append(self._family.start(name, command, self._environment, log))
        except OSError as error:
            raise RunError(f"{command[0]} cannot be started: {error.strerror}") from error
        return self._children[-1]

    def end(self, child: Child) -> None:
        """End one program as Ctrl-C would; it may take its time."""
        self.forget(child)
        child.process.send_signal(signal.SIGINT)
        try:
            child.process.wait(END_LIMIT)
        except subprocess.TimeoutExpired as late:
            output = child.last_lines()
            raise RunError(f"{child.name} did not end within {END_LIMIT:.0f} s", output) from late

    def forget(self, child: Child) -> None:
        """That this program ends is no failure any more."""
        self._children.remove(child)

    def wait(self, condition: Callable[[], object], limit: float, what: str) -> object:
        """What the condition gives once it is true; RunError after so many seconds."""
        until = time.monotonic() + limit
        while not (value := condition()):
            self.check()
            if time.monotonic() > until:
                output = self._children[-1].last_lines() if self._children else ""
                raise RunError(f"{what} was not there within {limit:.0f} s", output)
            time.sleep(POLL)
        return value

    def pause(self, seconds: float) -> None:
        """Let it run for so long (s, wall), and notice if a part of it ends."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self.check()
            time.sleep(min(left, 0.1))

    def check(self) -> None:
        """RunError if a program that was started here has ended."""
        for child in self._children:
            code = child.process.poll()
            if code is not None:
                ended = f"{child.name} ended ({describe_exit(code)}); log: {child.log}"
                raise RunError(ended, child.last_lines())


@contextmanager
def ros_run(settings: Settings, name: str, roscore: bool = True) -> Iterator[RosRun]:
    """A run whose logs go to OUT/log/NAME; everything it started has ended when this is left."""
    with Family() as family:
        run = RosRun(family, settings.out / "log" / name)
        if roscore:
            run.start_roscore()
        yield run


def read_lines(path: Path) -> list[tuple[float, ...]]:
    """A probe's file: numbers in columns; a line that is not whole yet is left out."""
    if not path.exists():
        return []
    whole = path.read_text(encoding="ascii").rpartition("\n")[0]
    return [tuple(float(word) for word in line.split()) for line in whole.splitlines()]


def cpu_figures(name: str, cpu: list[dict[str, float]], always: Sequence[str] = ()) -> list[Figure]:
    """`NAME.cpu.PROCESS`; `cpu` has each process's share in each window, %."""
    found = {process: [window.get(process, 0.0) for window in cpu]
             for process in sorted({process for window in cpu for process in window})}
    return [figure(f"{name}.cpu.{process}", PERCENT, shares) for process, shares in found.items()
            if max(shares) >= LEAST_CPU or process in always]
