#!/usr/bin/env python3
"""One case of mark.py, in a process of its own: mark_drive.py FOLDER, which holds case.json."""

import sys
from pathlib import Path

from marking.drive import main

if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
