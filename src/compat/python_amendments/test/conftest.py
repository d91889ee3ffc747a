"""Lets pytest import the packages from their source folders."""

import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[1] / "src"
sys.path[:0] = [str(SOURCE), str(SOURCE.parents[1] / "terminal_language/src"),
                str(SOURCE.parents[2] / "interfaces/node_basics/src")]
