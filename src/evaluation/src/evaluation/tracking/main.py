"""The command line of `make track`."""

from __future__ import annotations

from evaluation.tracking.options import parse_options
from evaluation.tracking.run import TrackRun
from evaluation.trial.live import run_live
from evaluation.trial.program import run_program


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("track", lambda: run_live(TrackRun(parse_options(arguments))))
