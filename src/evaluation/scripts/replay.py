#!/usr/bin/env python3
"""Goes back to an image of a run (--help)."""

import sys

from evaluation.replay import main

if __name__ == "__main__":
    sys.exit(main())
