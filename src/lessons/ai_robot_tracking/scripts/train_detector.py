#!/usr/bin/env python3
"""Renders images, trains the shipped detector on them, and reports its scores (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends the program without a traceback

from ai_robot_tracking.training.main import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
