#!/usr/bin/env python3
"""Compares all methods that find the lane on the same seeds (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.lane.comparison import LaneComparison  # noqa: E402
from evaluation.trial.runner import run_trial  # noqa: E402

if __name__ == "__main__":
    sys.exit(run_trial(LaneComparison(), sys.argv[1:]))
