#!/usr/bin/env python3
"""Drives AutoRace 2020 by the lessons, with many seeds, and scores each mission (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("autorace.trial", "RaceTrial")
