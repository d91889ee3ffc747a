#!/usr/bin/env python3
"""Follows the red cylinder without a screen, scores it and writes a report (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("tracking.run", "TrackRun")
