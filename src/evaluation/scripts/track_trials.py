#!/usr/bin/env python3
"""Follows the red cylinder in many seeded drives, and counts successes (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("tracking.trial", "TrackTrial")
