#!/usr/bin/env python3
"""Films one case of mark.py, as a node: mark_film.py FOLDER, which holds case.json."""

import sys
from pathlib import Path

from marking.film import main

if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
