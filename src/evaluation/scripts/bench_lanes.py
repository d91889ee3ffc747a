#!/usr/bin/env python3
"""Compares all methods that find the lane on the same seeds (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("lane.comparison", "LaneComparison")
