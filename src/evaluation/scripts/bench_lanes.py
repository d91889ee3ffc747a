#!/usr/bin/env python3
"""Compares all lane detection methods on the same seeds (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("lane.comparison", "LaneComparison")
