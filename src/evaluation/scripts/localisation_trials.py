#!/usr/bin/env python3
"""Has amcl find, find again and keep track of the waffle in the house (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("localisation.trial", "LocalisationTrial")
