"""Programs over ROS, on a master of their own, and what is measured of them from outside."""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np

from run_session import simulator
from run_session.files import find_package
from run_session.launch import Launched
from run_session.processes import Child, CpuMeter, Family
from run_session.session import Session
from sim_bench.figures import Figure, figure
from sim_bench.settings import Settings

START_LIMIT, END_LIMIT, LAP_LIMIT = 60.0, 10.0, 600.0  # s, wall
POLL = 0.02  # s, wall
QUICK_LAP = 15.0  # s, simulated
SIMULATOR = "gazebo"  # its process's name
PERCENT = "% of a core"
LEAST_CPU = 0.5  # % of a core; who uses less is left out
WAITING = "wait"  # for the picture before, while that is drawn: no work
LEAST = 0.02  # of all work; what takes less is left out
PROFILE = "profile:=true"
_TABLE = re.compile(r"^stage +times .*\n((?:.+%\n?)*)", re.MULTILINE)  # of the simulator's work
_ROW = re.compile(r"^(\S.*?) +(\d+) +([\d.]+) +[\d.]+ +[\d.]+%$", re.MULTILINE)  # times, ms each


class Window(NamedTuple):
    """What was measured between two moments on the wall (s)."""

    start: float
    end: float
    factor: float  # simulated seconds in one on the wall
    cpu: dict[str, float]  # each process's share of a core, %


class RosRun(Launched):
    """roscore, launch files and probes; logs go to OUT/log/NAME."""

    def __init__(self, family: Family, settings: Settings, name: str):
        super().__init__(family, settings.out / "log" / name, vehicle="waffle")
        self._settings = settings

    def launch(self, *arguments: str) -> Child:
        """roslaunch with these arguments."""
        name = f"roslaunch-{len(list(self.log_folder.glob('roslaunch-*')))}"
        return self.start(name, ["roslaunch", "-p", str(self.port), *arguments])

    def launch_world(self, *arguments: str) -> Child:
        """empty_world.launch without a screen; returns when the simulator answers."""
        launched = self.launch("gazebo_ros", "empty_world.launch", "gui:=false", *arguments)
        self.wait(simulator.models, "the simulator")
        return launched

    def probe(self, kind: str, *arguments: str) -> Child:
        """One of the nodes in `probes`, as a process of that name."""
        return self.start(kind, [sys.executable, "-P", "-m", "sim_bench.probes", kind, *arguments,
                                 f"__name:={kind}"])

    def listen(self, *topics: str) -> Child:
        """A process that hears these; returns when something of each has come."""
        file = self.log_folder / "heard.txt"
        file.unlink(missing_ok=True)
        listener = self.probe("listener", str(file), *topics)
        self.wait(lambda: len(set(read_lines(file))) == len(topics), "all topics")
        return listener

    def wait(self, condition: object, what: str) -> object:
        """What the condition gives once it is true; RunError if that takes too long."""
        return self.wait_for(what, condition, START_LIMIT, pause=POLL)

    def pause(self, seconds: float) -> None:
        """Let it run for so long (s, wall), and notice if a part of it ends."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self.check(None)
            time.sleep(min(left, 0.1))

    def stop(self, *children: Child) -> None:
        """End programs as Ctrl-C would; each may take its time."""
        for child in children:
            self.end(child, END_LIMIT)

    def windows(self, count: int, length: float, warm_up: float) -> list[Window]:
        """After `warm_up` s, `count` windows of `length` s of wall time, one after the other.

        Fewer and shorter ones in a quick pass.
        """
        self.pause(warm_up)
        meter, found = CpuMeter(), []
        for _ in range(self._settings.runs(count)):
            start, simulated = time.monotonic(), simulator.simulated_time()
            self.pause(self._settings.seconds(length))
            factor = (simulator.simulated_time() - simulated) / (time.monotonic() - start)
            found.append(Window(start, time.monotonic(), factor, meter.look()))
        return found


@contextmanager
def ros_run(settings: Settings, name: str) -> Iterator[RosRun]:
    """A run with its roscore; everything it started has ended when this is left."""
    with Family() as family:
        run = RosRun(family, settings, name)
        run.start_roscore()
        yield run


def marked_lap(settings: Settings, name: str, *options: str) -> dict:
    """report.json of one lap of lesson 05 as `make course` runs it, film and scoring included.

    Of 15 simulated seconds in a quick pass.
    """
    script = str(find_package("evaluation") / "scripts" / "course_run.py")
    folder = settings.out / "log" / name
    short = ("--duration", str(QUICK_LAP)) if settings.quick else ()
    command = [sys.executable, "-P", script, "--out", str(folder / "course"), *short, *options]
    with Session(folder) as session:
        return session.drive(command, folder / "course", "a lap", LAP_LIMIT)


def read_lines(path: Path) -> list[tuple[float, ...]]:
    """A probe's file: numbers in columns; a line that is not whole yet is left out."""
    if not path.exists():
        return []
    whole = path.read_text(encoding="ascii").rpartition("\n")[0]
    return [tuple(float(word) for word in line.split()) for line in whole.splitlines()]


def cpu_figures(name: str, windows: Sequence[Window], always: Sequence[str] = ()) -> list[Figure]:
    """`NAME.cpu.PROCESS`."""
    found = {process: [window.cpu.get(process, 0.0) for window in windows]
             for process in sorted({process for window in windows for process in window.cpu})}
    return [figure(f"{name}.cpu.{process}", PERCENT, shares) for process, shares in found.items()
            if max(shares) >= LEAST_CPU or process in always]


def stages(log: Path, turn: str) -> dict[str, float]:
    """ms of wall time that each stage of the simulator's work takes in a turn.

    From the tables that `profile:=true` prints, the first to the last, or the only one. A turn is
    what the stage `turn` is done once in, a frame for example; empty where it was not done.
    """
    text = log.read_text(encoding="utf-8", errors="replace")
    tables = [{name: (int(times), int(times) * float(ms)) for name, times, ms in _ROW.findall(each)}
              for each in _TABLE.findall(text)]
    if not tables:
        return {}
    first, last = (tables[0] if len(tables) > 1 else {}), tables[-1]
    spent = {stage: np.subtract(done, first.get(stage, (0, 0.0))) for stage, done in last.items()}
    turns = spent[turn][0] if turn in spent else 0
    return {stage: ms / turns for stage, (_, ms) in spent.items() if stage != WAITING and turns > 0}


def stage_figures(name: str, work: dict[str, float]) -> list[Figure]:
    """`NAME.stage.STAGE`, the greatest first, without those that make no difference."""
    least = LEAST * sum(work.values())
    return [figure(f"{name}.stage.{stage.replace(' ', '_')}", "ms", [ms])
            for stage, ms in sorted(work.items(), key=lambda item: -item[1]) if ms > least]
