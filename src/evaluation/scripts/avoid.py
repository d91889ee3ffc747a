#!/usr/bin/env python3
"""Drives by laser through halls with columns (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("avoid.trial", "AvoidTrial")
