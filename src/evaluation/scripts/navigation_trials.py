#!/usr/bin/env python3
"""Drives the waffle through many narrow yards, and past people who cross its path (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("yards.trial", "YardTrial")
