#!/usr/bin/env python3
"""Writes this package's worlds and models: `make_worlds.py [FOLDER]`; the same bytes each time."""

import argparse
import sys
from pathlib import Path

from turtlebot3_gazebo.making.everything import everything

PACKAGE = Path(__file__).resolve().parent.parent


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=PACKAGE)
    folder = parser.parse_args().folder
    for path, data in everything().items():
        try:
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(data)
        except OSError as error:
            sys.exit(f"make_worlds.py: {folder / path}: {error.strerror}")
        print(f"{folder / path}: {len(data)} bytes")


if __name__ == "__main__":
    main()
