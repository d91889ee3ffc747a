"""A drive by hand: a master, the world and who drives in it, each in a terminal of its own."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
from functools import partial
from pathlib import Path

from course import Course
from drive import LAUNCH, Watched
from members import matching, send, wait_until

from run_session.launch import DIED, USUAL_PORT, is_up
from run_session.processes import read_log

MASTER = f"http://localhost:{USUAL_PORT}"  # nobody else's: a round has a network of its own
ROSCORE, WORLD = "roscore", "world"  # terminals; others have their driver's name
OWNERS = {"simulator": WORLD, "roslaunch": WORLD, "master": ROSCORE}  # their terminals

CORE_IS_UP = "started core service"  # a roscore whose master is killed before does not end well
# Of roslaunch's, but for roscore's own, and for what is no node and ends with the master.
NODE = r"__name:=(?!rosout\b|gazebo_gui\b)"


class Terminals(Watched):
    """A terminal is open from the start of its command to its end; it may be opened again."""

    def __init__(self, course: Course, folder: Path, roscore: bool):
        """Without `roscore` it is roslaunch that starts a master, and ends it."""
        super().__init__(course, folder, {
            "ROS_MASTER_URI": MASTER, "ROS_LOG_DIR": str(folder / "log" / "ros"),
            "PYTHONUNBUFFERED": "1"})
        first = next(iter(course.by_hand.commands))
        self.usual = [*([ROSCORE] if roscore else []), WORLD, first]
        self.open: dict[str, subprocess.Popen] = {}
        self._logs: dict[str, list[Path]] = {}
        (folder / "log").mkdir()

    def lives(self) -> bool:
        """Whether nothing has ended by itself."""
        return all(process.poll() is None for process in self.open.values())

    def pids(self, victim: str) -> list[int]:
        """Of drivers by their file: most choose a name of their own."""
        if words := self.course.by_hand.commands.get(victim):
            return matching(self.mark, re.escape(words[1]))
        return super().pids(victim)

    def start(self, name: str) -> None:
        """Type its command."""
        log = self.folder / "log" / f"{name}-{len(self._logs.setdefault(name, []))}.log"
        self._logs[name].append(log)
        with log.open("wb") as output:
            self.open[name] = subprocess.Popen(
                self._command(name), stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, start_new_session=True, cwd=self.folder,
                env=self._environment)

    def start_usual(self, limit: float, last: str = "") -> bool:
        """Start what is not open, each when what it needs is there; whether it is within `limit`,
        s, wall, each. That of `last` is not waited for."""
        for name in self.usual:
            if name not in self.open:
                self.start(name)
            if name == last:
                return True
            if not self.wait_for(partial(self._is_ready, name), limit):
                return False
        return True

    def interrupt(self, victim: str) -> None:
        """Ctrl-C in the terminal of one of PATTERNS or a driver; one that roslaunch has started
        has none."""
        if terminal := self.open.get(OWNERS.get(victim, victim)):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(terminal.pid, signal.SIGINT)
        else:
            send(self.pids(victim), signal.SIGINT)

    def ended(self, name: str, limit: float) -> bool:
        """Whether its command is over within `limit` s, wall; the terminal is closed then."""
        if not wait_until(lambda: self.open[name].poll() is not None, limit):
            return False
        del self.open[name]
        return True

    def kill_nodes(self, limit: float) -> bool:
        """`rosnode kill -a`, again for those that were only starting; whether nothing that
        roslaunch has started is left within `limit`, s, wall."""

        def are_gone() -> bool:
            if not matching(self.mark, NODE):
                return True
            subprocess.run(["rosnode", "kill", "-a"], capture_output=True, check=False,
                           cwd=self.folder, env=self._environment)
            return False

        return wait_until(are_gone, limit)

    def said(self, name: str) -> list[str]:
        """Lines, since its command was typed last."""
        return read_log(self._logs[name][-1])

    def dead_nodes(self) -> set[str]:
        """Of this world, those that did not end well."""
        return {found[1].rsplit("-", 1)[0] for found in DIED.finditer("\n".join(self.said(WORLD)))}

    def _command(self, name: str) -> list[str]:
        if name == ROSCORE:
            return ["roscore"]
        if name == WORLD:
            self.states = self.folder / f"states-{len(self._logs[name])}"
            package, file, *words = self.course.by_hand.world
            self._write_launch((package, file))
            return ["roslaunch", *LAUNCH, *words]
        return ["rosrun", *self.course.by_hand.commands[name]]

    def _is_ready(self, name: str) -> bool:
        if name == WORLD:
            return bool(self.places())
        if name == ROSCORE:
            return is_up(MASTER) and any(line.startswith(CORE_IS_UP) for line in self.said(name))
        return True
