#!/usr/bin/env python3
"""Maps a house, starts again on that map, visits goals, and scores it all (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("navigation.main", "NavigationRun")
