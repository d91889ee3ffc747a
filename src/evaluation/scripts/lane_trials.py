#!/usr/bin/env python3
"""The program of this name (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start()
