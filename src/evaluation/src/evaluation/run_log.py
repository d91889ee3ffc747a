"""The log of a run in lockstep, as evaluation has it written and adds to it."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import rosgraph

from bullet_sim.formats.run_log import Mark, RunLogError, append_marks, read_run_log

RUN_LOG, EARLIER = "run.log.gz", "earlier.run.log.gz"
# By which launch files and the simulator choose robots and find files.
VARIABLES = ("TURTLEBOT3_MODEL", "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH", "GAZEBO_PLUGIN_PATH")


def add_marks(path: Path, marks: Sequence[Mark]) -> None:
    """Add marks to a run's log, if there is one; a line says if that fails."""
    try:
        if path.exists():
            append_marks(path, marks)
    except OSError as error:
        print(f"no marks in {path}: {error.strerror}; all other results are there", file=sys.stderr)


def marks_in(path: Path) -> Sequence[Mark]:
    """The marks of a run's log; none if there is no log that can be read."""
    try:
        return read_run_log(path).marks
    except (OSError, RunLogError):
        return ()


def begin_run_log(master_uri: str, path: Path, words: Sequence[str], driver: str,
                  sensor: str, commands: str, controllers: str = "",
                  environment: Mapping[str, str] | None = None) -> None:
    """Have the next simulator at this master write a log to this file.

    `words`: those of roslaunch, in lockstep; `driver`: the program that drives, by its file's name;
    `sensor`: the topic that it answers, `commands`: that of its answers; `controllers`: the
    namespace of the robot's controller manager, or ""; `environment`: the values of VARIABLES (as
    they are here).
    """
    path.unlink(missing_ok=True)
    of = {"words": list(words), "driver": driver, "sensor": sensor, "commands": commands,
          "controllers": controllers,
          "environment": {name: os.environ[name] for name in VARIABLES if name in os.environ}
          if environment is None else environment}
    master = rosgraph.Master("/run_log", master_uri)
    master.setParam("/gazebo/run_log", str(path))
    master.setParam("/gazebo/run_log_of", json.dumps(of))
