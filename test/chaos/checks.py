"""What must hold after a round."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import cv2

COMPLAINT = "course_run: "
TRACEBACK = "Traceback (most recent call last):\n"
FAILURE = re.compile(
    r"^(?!KeyboardInterrupt|Exception ignored)[\w.]*(Error|Exception|Interrupt|Iteration)\b", re.M)
RAISED = re.compile(r"^ .*\n(?!KeyboardInterrupt|Exception ignored)([\w.]+)(?=:|$)", re.M)
LOGGING = re.compile(r'  File "[^"]*/logging/\w+\.py"')
ROSVERSION = '  File "/usr/bin/rosversion"'
NO_ENDING = ("course_run: no film", )  # a message after which the run goes on


def wrong_words(said: str, code: int | None) -> Iterator[str]:
    """A program that ends early must print exactly one line."""
    if _has_traceback(said) or "KeyboardInterrupt" in said:
        yield "the judge prints a traceback"
    lines = [line for line in said.splitlines() if line.startswith(COMPLAINT)
             and not line.startswith(NO_ENDING)]
    if code == 2 and len(lines) != 1:
        yield f"the judge ends with {len(lines)} lines"


def wrong_logs(folder: Path) -> Iterator[str]:
    """No log may contain a traceback."""
    for path in sorted(folder.glob("*.log")):
        if _has_traceback(path.read_text(encoding="utf-8", errors="replace")):
            yield f"a traceback in {path.name}"


def _has_traceback(text: str) -> bool:
    """Whether there is a traceback that is ours to prevent."""
    return not all(map(_is_anothers, text.split(TRACEBACK)[1:]))


def _is_anothers(traceback: str) -> bool:
    """Python's own, on Ctrl-C while modules load or on a full disk while logging, or that of
    Debian's rosversion, whose roscore was killed. Lines of simultaneous tracebacks are mixed."""
    raised = RAISED.search(traceback)
    if LOGGING.match(traceback):
        return raised is None or raised[1] == "OSError"
    return traceback.startswith(ROSVERSION) or not (raised or FAILURE.search(traceback))


def half_files(folder: Path) -> Iterator[str]:
    """Yields result files that are incomplete."""
    for path in sorted(folder.rglob("*")):
        named_so = path.parent.name == "log" or ".part" in path.suffixes
        if path.is_file() and not named_so and not _is_whole(path):
            yield f"{path.name} is not whole"


def _is_whole(path: Path) -> bool:
    if path.suffix == ".json":
        try:
            json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            return False
    elif path.suffix == ".png":
        return path.read_bytes().endswith(b"IEND\xaeB`\x82")
    elif path.suffix == ".mp4":
        film = cv2.VideoCapture(str(path))
        return film.read()[0]
    return path.suffix != ".tmp"
