"""A drive by hand: a master, the world and the drivers, each in a terminal of its own."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
from functools import partial
from pathlib import Path

from course import CourseUnderTest
from drive import LAUNCH, Watched
from members import matching, send, wait_until

from run_session.launch import DIED
from run_session.master import USUAL, is_up
from run_session.processes import read_log

MASTER = USUAL  # not shared: a round has a network of its own
ROSCORE, WORLD = "roscore", "world"  # terminals; others have their driver's name
OWNERS = {"simulator": WORLD, "roslaunch": WORLD, "master": ROSCORE}  # their terminals

CORE_IS_UP = "started core service"  # before this line, roscore does not cope with a killed master
# Nodes of roslaunch, without roscore's own, and without gazebo_gui, which ends with the master.
NODE = r"__name:=(?!rosout\b|gazebo_gui\b)"


class Terminals(Watched):
    """A terminal is open from the start of its command to its end; it may be opened again."""

    def __init__(self, course: CourseUnderTest, folder: Path, roscore: bool):
        """Without `roscore`, roslaunch starts the master, and ends it."""
        super().__init__(course, folder, {
            "ROS_MASTER_URI": MASTER, "ROS_LOG_DIR": str(folder / "log" / "ros"),
            "PYTHONUNBUFFERED": "1"})
        first = next(iter(course.by_hand.commands))
        self.usual = [*([ROSCORE] if roscore else []), WORLD, first]
        self.open: dict[str, subprocess.Popen] = {}
        self._logs: dict[str, list[Path]] = {}
        (folder / "log").mkdir()

    def lives(self) -> bool:
        """Whether no command has ended by itself."""
        return all(process.poll() is None for process in self.open.values())

    def pids(self, victim: str) -> list[int]:
        """Process ids; drivers are matched by file, as most choose their own node name."""
        if words := self.course.by_hand.commands.get(victim):
            return matching(self.mark, re.escape(words[1]))
        return super().pids(victim)

    def start(self, name: str) -> None:
        """Start the command of this terminal."""
        log = self.folder / "log" / f"{name}-{len(self._logs.setdefault(name, []))}.log"
        self._logs[name].append(log)
        with log.open("wb") as output:
            self.open[name] = subprocess.Popen(
                self._command(name), stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, start_new_session=True, cwd=self.folder,
                env=self._environment)

    def start_usual(self, limit: float, last: str = "") -> bool:
        """Start terminals that are not open, each once what it needs is up; False if one takes
        longer than `limit`, s, wall. Does not wait for that of `last`."""
        for name in self.usual:
            if name not in self.open:
                self.start(name)
            if name == last:
                return True
            if not self.wait_for(partial(self._is_ready, name), limit):
                return False
        return True

    def interrupt(self, victim: str) -> None:
        """Ctrl-C in the terminal of one of PATTERNS or a driver; a node started by roslaunch has
        no terminal and gets the signal itself."""
        if terminal := self.open.get(OWNERS.get(victim, victim)):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(terminal.pid, signal.SIGINT)
        else:
            send(self.pids(victim), signal.SIGINT)

    def ended(self, name: str, limit: float) -> bool:
        """Whether its command ends within `limit` s, wall; the terminal is then closed."""
        if not wait_until(lambda: self.open[name].poll() is not None, limit):
            return False
        del self.open[name]
        return True

    def kill_nodes(self, limit: float) -> bool:
        """`rosnode kill -a`, repeated for nodes that were still starting; whether all nodes started
        by roslaunch end within `limit`, s, wall."""

        def are_gone() -> bool:
            if not matching(self.mark, NODE):
                return True
            subprocess.run(["rosnode", "kill", "-a"], capture_output=True, check=False,
                           cwd=self.folder, env=self._environment)
            return False

        return wait_until(are_gone, limit)

    def said(self, name: str) -> list[str]:
        """Output lines since its command was last started."""
        return read_log(self._logs[name][-1])

    def dead_nodes(self) -> set[str]:
        """Nodes of this world that died."""
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
