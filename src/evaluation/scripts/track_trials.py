#!/usr/bin/env python3
"""Follows the red cylinder in many seeded drives, and counts (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from evaluation.tracking.trials import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
