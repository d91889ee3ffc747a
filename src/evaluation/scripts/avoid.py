#!/usr/bin/env python3
"""Drives through halls with columns, guided by the laser (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("avoid.trial", "AvoidTrial")
