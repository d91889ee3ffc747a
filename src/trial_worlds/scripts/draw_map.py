#!/usr/bin/env python3
"""Draws the true map of a world, as map_server reads it: NAME.pgm and NAME.yaml.

  draw_map.py WORLD NAME --height 0.18 --inside -2.0 -0.5

The map's frame is the world's. The same world gives the same bytes.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from bullet_sim.errors import SimulationError
from map_server.map_files import write_map
from trial_worlds.house import open_walls, true_map


def main() -> int:
    """The exit status: 0, or 1 with one line that says what is wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world", type=Path, help="the world's file")
    parser.add_argument("name", type=Path, help="writes NAME.pgm and NAME.yaml")
    parser.add_argument("--height", type=float, default=0.18, help="m, the laser's; default: 0.18")
    parser.add_argument("--inside", type=float, nargs=2, default=[0.0, 0.0], metavar=("X", "Y"),
                        help="m, a place where a robot can be; default: 0 0")
    parser.add_argument("--reach", type=float, default=16.0,
                        help="m from the world's origin to each side; default: 16")
    options = parser.parse_args()
    try:
        world = open_walls(options.world)
        try:
            grid = true_map(world, options.height, [tuple(options.inside)], reach=options.reach)
        finally:
            world.close()
        print("wrote", *write_map(options.name, grid))
    except (SimulationError, ValueError) as error:
        print(f"draw_map.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
