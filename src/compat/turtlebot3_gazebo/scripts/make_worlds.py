#!/usr/bin/env python3
"""Writes this package's worlds and models: `make_worlds.py [FOLDER]`; the same bytes each time."""

import sys
from pathlib import Path

from turtlebot3_gazebo.making.everything import everything

PACKAGE = Path(__file__).resolve().parent.parent


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PACKAGE
    for path, data in everything().items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
        print(f"{folder / path}: {len(data)} bytes")


if __name__ == "__main__":
    main()
