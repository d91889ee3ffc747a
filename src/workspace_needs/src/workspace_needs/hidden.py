"""The line on the courses' packages that a learner's own of the same name hides.

    python3 -m workspace_needs.hidden SETUP NAME...     SETUP: the courses' own setup.bash

The shell calls this only where a package hides one of the courses' (env-hooks of this package).
"""

import sys


def line(setup: str, names: list[str]) -> str:
    """What is hidden, and how to reach it."""
    return (f"Your own {', '.join(names)} hides the courses' package of that name: rosrun and "
            f"roslaunch take yours. In a terminal for the courses' type: source {setup}")


def main(words: list[str]) -> int:
    """Print the line; returns the exit code."""
    setup, *names = words
    print(line(setup, sorted(set(names))), file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
