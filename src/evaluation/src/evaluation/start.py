"""Starts a program of this package; Ctrl-C while its modules load ends it quietly."""

from __future__ import annotations

import importlib
import signal
import sys
from typing import NoReturn


def start(module: str, program: str) -> NoReturn:
    """Run class `program`, a Trial or LiveDrive in evaluation.MODULE, with the command line."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    runner = importlib.import_module("evaluation.trial.runner")
    live = importlib.import_module("evaluation.trial.live")
    found = getattr(importlib.import_module(f"evaluation.{module}"), program)
    if issubclass(found, live.LiveDrive):
        sys.exit(live.run_program_of(found, sys.argv[1:]))
    sys.exit(runner.run_trial(found(), sys.argv[1:]))
