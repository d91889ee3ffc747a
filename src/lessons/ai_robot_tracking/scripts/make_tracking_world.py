#!/usr/bin/env python3
"""Writes the world file of a tracking scene (--help)."""

import argparse
import sys
from pathlib import Path

from ai_robot_tracking.scenes.scene import KINDS, draw_scene
from ai_robot_tracking.scenes.world_file import world_text


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="make_tracking_world.py",
        description="Write a world with a red cylinder that moves as its seed says.")
    parser.add_argument("kind", choices=KINDS, help="what makes it hard to track")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of path and objects (0)")
    parser.add_argument("--out", type=Path, metavar="FILE", help="file (standard output)")
    given = parser.parse_args()
    if given.seed < 0:
        parser.error(f"--seed must be a whole number, 0 or more; got {given.seed}")
    text = world_text(draw_scene(given.kind, given.seed))
    if given.out is None:
        sys.stdout.write(text)
        return 0
    try:
        given.out.write_text(text, encoding="utf-8")
    except OSError as error:
        parser.error(f"--out {given.out}: {error.strerror}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
