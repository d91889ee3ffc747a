#!/usr/bin/env python3
"""Follows the red cylinder in many seeded drives, and counts (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.tracking.trial import TrackTrial  # noqa: E402
from evaluation.trial.runner import run_trial  # noqa: E402

if __name__ == "__main__":
    sys.exit(run_trial(TrackTrial(), sys.argv[1:]))
