#!/usr/bin/env python3
"""Drives AutoRace 2020 with the lessons' nodes and many seeds, scoring each mission (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("autorace.trial", "RaceTrial")
