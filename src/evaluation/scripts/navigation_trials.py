#!/usr/bin/env python3
"""Drives the waffle through many narrow yards, and past persons who cross its way (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.trial.runner import run_trial  # noqa: E402
from evaluation.yards.trial import YardTrial  # noqa: E402

if __name__ == "__main__":
    sys.exit(run_trial(YardTrial(), sys.argv[1:]))
