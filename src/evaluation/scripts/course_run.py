#!/usr/bin/env python3
"""Every program of this package, by the name under which it is called (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start()
