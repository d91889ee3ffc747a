#!/usr/bin/env python3
"""Writes the world of a hall with columns: make_hall.py [SEED] [--out FILE]."""

import argparse
import sys
from pathlib import Path

from learning_laser.hall import world

HALL = Path(__file__).resolve().parents[1] / "worlds" / "hall.world"


def main() -> int:
    parser = argparse.ArgumentParser(prog="make_hall.py", description=__doc__)
    parser.add_argument("seed", type=int, nargs="?", default=0, help="of the columns' places (0)")
    parser.add_argument("--out", type=Path, default=HALL, metavar="FILE", help=f"({HALL})")
    options = parser.parse_args()
    if options.seed < 0:
        parser.error(f"SEED must be 0 or more, not {options.seed}")
    if options.seed and options.out == HALL:
        parser.error(f"{HALL} is hall 0; give another file: --out my_hall.world")
    try:
        options.out.write_text(world(options.seed), encoding="utf-8")
    except OSError as error:
        print(f"make_hall.py: {options.out}: {error.strerror}; give another --out", file=sys.stderr)
        return 1
    print(f"{options.out}: hall {options.seed}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
