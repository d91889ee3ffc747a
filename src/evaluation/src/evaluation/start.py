"""Starts a program of this package; Ctrl-C while its modules load ends it quietly."""

from __future__ import annotations

import importlib
import signal
import sys
from pathlib import Path
from typing import NoReturn

# By the program's name: a module of this package, and its Trial or LiveDrive.
PROGRAMS = {
    "autorace": ("autorace", "RaceTrial"), "avoid": ("avoid", "AvoidTrial"),
    "bench_lanes": ("lane_trials", "LaneComparison"),
    "course_run": ("course_run", "CourseRun"), "lane_trials": ("lane_trials", "LaneTrial"),
    "localisation_trials": ("localisation_trials", "LocalisationTrial"),
    "navigate": ("navigate", "NavigationRun"),
    "navigation_trials": ("navigation_trials", "YardTrial"),
    "race_trials": ("race_trials", "RaceTrial"), "track": ("track", "TrackRun"),
    "track_trials": ("track_trials", "TrackTrial")}


def start() -> NoReturn:
    """Run the program whose name is that of the script, with the command line."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    runner = importlib.import_module("evaluation.trial")
    live = importlib.import_module("evaluation.live")
    module, name = PROGRAMS[Path(sys.argv[0]).stem]
    found = getattr(importlib.import_module(f"evaluation.{module}"), name)
    if issubclass(found, live.LiveDrive):
        sys.exit(live.run_program_of(found, sys.argv[1:]))
    sys.exit(runner.run_trial(found(), sys.argv[1:]))
