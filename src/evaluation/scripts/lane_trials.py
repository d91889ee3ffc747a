#!/usr/bin/env python3
"""Drives many laps in varied light and past people who cross the road (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("lane.trial", "LaneTrial")
