#!/usr/bin/env python3
"""Grade one submission: rosrun marking grade.py --file FILE."""

import sys

from marking.grade import GradingTrial

from evaluation.trial import run_trial

if __name__ == "__main__":
    sys.exit(run_trial(GradingTrial(), sys.argv[1:]))
