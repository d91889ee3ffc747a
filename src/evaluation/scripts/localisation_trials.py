#!/usr/bin/env python3
"""Has amcl find, find again and keep track of the waffle in the house (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.localisation.trial import LocalisationTrial  # noqa: E402
from evaluation.trial.runner import run_trial  # noqa: E402

if __name__ == "__main__":
    sys.exit(run_trial(LocalisationTrial(), sys.argv[1:]))
