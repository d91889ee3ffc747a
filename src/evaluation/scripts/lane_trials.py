#!/usr/bin/env python3
"""Drives many laps in differing light and past people who cross (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.lane.trial import LaneTrial  # noqa: E402
from evaluation.trial.runner import run_trial  # noqa: E402

if __name__ == "__main__":
    sys.exit(run_trial(LaneTrial(), sys.argv[1:]))
