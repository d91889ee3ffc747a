#!/usr/bin/env python3
"""Stops lesson 5 at a breakpoint, types at pdb, and writes what the terminal shows as a picture."""

from __future__ import annotations

import argparse
import contextlib
import os
import pty
import re
import signal
import sys
import tempfile
import time
from pathlib import Path

import cv2
import rospkg
import rospy
from lesson_pictures import Photographer, start_master, terminal_page
from node_basics.ending import interruptible

from run_session.failure import RunError
from run_session.processes import Family

ROOT = Path(__file__).resolve().parents[2]
LESSON = "05follower_proporation.py"
CALLBACK = "    def image_callback(self, msg):\n"
PROMPT = b"(Pdb) "
TYPED = ("n", "p msg.header.stamp.to_sec(), image.shape", "n", "p centre", "c")
LIMIT = 60.0  # s, wall, for each prompt
CODES = re.compile(r"\x1b\[[?\d;]*[a-zA-Z]")
UNDRAWN = re.compile(r"\s*[^\x00-\x7f]+")  # comments in Chinese, which OpenCV's font has not
COURSE = ("roslaunch", "learning_topic", "0course.launch", "gui:=false", "lockstep:=/cmd_vel",
          "lockstep_timeout:=0")


def typed_at(program: Path) -> list[str]:
    """The lines of a terminal in which the program runs, up to the prompt after TYPED."""
    process, keys = pty.fork()
    if process == 0:
        os.execvpe(sys.executable, [sys.executable, str(program)], os.environ | {"TERM": "dumb"})
    text, until = b"", time.monotonic() + LIMIT
    try:
        for words in (*TYPED, None):
            before = len(text)
            while PROMPT not in text[before:]:
                text += os.read(keys, 65536)
                if time.monotonic() > until:
                    raise RunError(f"no prompt within {LIMIT:.0f} s: {text.decode()}")
            if words is not None:
                os.write(keys, f"{words}\n".encode())
    finally:
        os.kill(process, signal.SIGINT)
        with contextlib.suppress(OSError):  # until it has ended
            while os.read(keys, 65536):
                pass
        os.waitpid(process, 0)
    shown = CODES.sub("", text.decode()).replace(str(program.parent), "scripts").splitlines()
    begin = next(number for number, line in enumerate(shown) if line.startswith("> "))
    return [f"$ rosrun learning_topic {LESSON}", *(
        UNDRAWN.sub("", line) for line in shown[begin:] if not line.startswith("[INFO]"))]


def main() -> int:
    """The exit status: 0, or 1 with one line that says what went wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "docs/images/breakpoint.png")
    parser.add_argument("--log", type=Path, default=Path("out/breakpoint_picture"))
    options = parser.parse_args()
    os.environ["LANGUAGE"] = "en"
    source = Path(rospkg.RosPack().get_path("learning_topic")) / "scripts" / LESSON
    try:
        with interruptible(), Family() as family, tempfile.TemporaryDirectory() as folder:
            launched = start_master(family, options.log)
            launched.start("roslaunch", list(COURSE))
            Photographer(launched, options.out.parent).wait_for_car()
            program = Path(folder, LESSON)
            program.write_text(source.read_text("utf-8").replace(
                CALLBACK, CALLBACK + "        breakpoint()\n"), "utf-8")
            page = terminal_page(typed_at(program))
        cv2.imwrite(str(options.out), page, [cv2.IMWRITE_PNG_COMPRESSION, 9])
    except (RunError, rospy.ROSException) as error:
        print(f"breakpoint_picture: {error}", file=sys.stderr)
        return 1
    print(options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
