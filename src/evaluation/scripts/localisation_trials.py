#!/usr/bin/env python3
"""Tests how amcl localises, relocalises and tracks the waffle in the house (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("localisation.trial", "LocalisationTrial")
