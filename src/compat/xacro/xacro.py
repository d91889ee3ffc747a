#!/usr/bin/env python3
"""The `xacro` command: expands a file, with $(find …) answered by rospack. xacro.py links here."""

import argparse
import logging
import sys
import traceback
from functools import cache
from pathlib import Path

# The xacro.py beside this file would hide the Python module of that name, which does the work.
HERE = Path(__file__).resolve().parent
sys.path[:] = [entry for entry in sys.path if Path(entry).resolve() != HERE]

import rospkg  # noqa: E402
from xacro.cli import REMAP, load_mappings  # noqa: E402

from bullet_sim.errors import FormatError  # noqa: E402
from bullet_sim.formats.xacro.bounds import run_bounded  # noqa: E402
from bullet_sim.formats.xacro.files import expand_file  # noqa: E402

FAILED = 2  # upstream's exit code for every mistake
OLD_OPTIONS = ("--legacy", "--check-order", "--includes", "--xacro-ns")


@cache
def packages() -> rospkg.RosPack:
    return rospkg.RosPack()


def find_package(name: str) -> str:
    """The package's folder, as rospack finds it."""
    try:
        return packages().get_path(name)
    except rospkg.ResourceNotFound:
        places = ", ".join(packages().get_ros_paths())
        raise LookupError(f"no package {name} below {places}; is its workspace sourced?") from None


def parse(argv: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="xacro", usage="%(prog)s [options] <input> [name:=value …]",
        description="Expands a xacro file to URDF or SDF.")
    add = parser.add_argument
    add("input")
    add("-o", dest="output", metavar="FILE", help="write to FILE instead of stdout")
    add("--deps", action="store_true", help="print the files that are included")
    add("-q", dest="verbosity", action="store_const", const=0, help="no warnings")
    add("-v", dest="verbosity", action="count", help="a stack trace on errors")
    add("--verbosity", type=int, metavar="LEVEL", help="0: as -q, 1: default, 2: as -v")
    add("--inorder", "-i", action="store_true", help="no effect: this is the order used")
    add(*OLD_OPTIONS, action="store_true", help="no effect: accepted from older releases")
    parser.set_defaults(verbosity=1)
    options = parser.parse_args([word for word in argv if REMAP not in word])
    options.mappings = load_mappings(argv)
    return options


def write(text: str, output: str | None) -> None:
    if output is None:
        sys.stdout.reconfigure(encoding="utf-8")  # whatever the terminal's: roslaunch reads UTF-8
        sys.stdout.write(text)
        return
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    Path(output).write_text(text, encoding="utf-8")


def main(argv: list[str]) -> int:
    try:
        options = parse(argv)
    except RuntimeError as error:  # name:=value:=value
        print(f"xacro: error: {str(error).strip()}", file=sys.stderr)
        return FAILED
    level = logging.WARNING if options.verbosity else logging.ERROR
    logging.basicConfig(format="xacro: %(message)s", level=level, stream=sys.stderr)
    try:
        return run_bounded(lambda: expand_and_write(options), options.input)
    except FormatError as error:  # out of processor time
        print(f"xacro: error: {error}", file=sys.stderr)
        return FAILED


def expand_and_write(options: argparse.Namespace) -> int:
    """The exit code."""
    try:
        expansion = expand_file(options.input, options.mappings, find_package)
        files = " ".join(dict.fromkeys(expansion.files)) + "\n"
        write(files if options.deps else expansion.text, options.output)
    except (FormatError, OSError) as error:
        if options.verbosity > 1:
            traceback.print_exc()
        print(f"xacro: error: {error}", file=sys.stderr)
        return FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
