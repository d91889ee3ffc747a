#!/usr/bin/env python3
"""Benchmarks the simulator against PyBullet's renderers and bare engine."""

import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while modules load: just end

from sim_bench.main import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
