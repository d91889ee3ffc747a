#!/usr/bin/env python3
"""Mark a folder of submissions: rosrun marking mark.py --submissions FOLDER."""

import sys

from marking.trial import MarkingTrial

from evaluation.trial import run_trial

if __name__ == "__main__":
    sys.exit(run_trial(MarkingTrial(), sys.argv[1:]))
