#!/usr/bin/env python3
"""Drives many laps, each disturbed in its own way, and compares followers (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("race_trials.trial", "RaceTrial")
