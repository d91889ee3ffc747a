#!/usr/bin/env python3
"""Drives many laps, each disturbed in its own way, and compares followers (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.race_trials.trial import RaceTrial  # noqa: E402
from evaluation.trial.runner import run_trial  # noqa: E402

if __name__ == "__main__":
    sys.exit(run_trial(RaceTrial(), sys.argv[1:]))
