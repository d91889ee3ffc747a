#!/usr/bin/env python3
"""Draws pictures, trains the shipped detector with them, and reports how good it is (--help)."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends the program without a traceback

from ai_robot_tracking.training.main import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
