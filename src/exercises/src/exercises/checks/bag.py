"""A program that writes a bag with messages at given times into its working directory."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import rosbag

from exercises.errors import Mistake
from exercises.finding import Finding, holds, near
from exercises.program import compiled

NAME = "test.bag"
LIMIT = 60  # s, wall
RUN = """import runpy, sys, time
def sleep(_):
    sys.exit("it waits: give each message its time instead")
time.sleep = sleep
runpy.run_path(sys.argv[1], run_name="__main__")
"""


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The bag must have the right number of messages and intervals, written without waiting."""
    compiled(file)
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run([sys.executable, "-c", RUN, file], cwd=folder, timeout=LIMIT,
                                  text=True, capture_output=True, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired as error:
            raise Mistake(f"{file}: not done after {LIMIT} s: write the times, do not wait") \
                from error
        if done.returncode:
            raise Mistake(f"{file}: {(done.stderr.strip() or 'it failed').splitlines()[-1]}")
        if not (Path(folder) / NAME).is_file():
            raise Mistake(f"{file}: has written no {NAME}")
        try:
            with rosbag.Bag(Path(folder) / NAME) as bag:
                times = np.array([time.to_sec() for _, _, time in bag.read_messages()])
        except rosbag.ROSBagException as error:
            raise Mistake(f"{file}: {NAME} cannot be read: {error}: is it closed?") from error
    count = round(limits["messages"])
    yield holds("messages", str(len(times)), str(count), len(times) == count)
    apart = np.diff(times) if len(times) > 1 else np.array([np.nan])
    worst = float(apart[np.abs(apart - limits["period"]).argmax()])
    yield near("time between two messages, the worst", worst, limits["period"],
               limits["tolerance"], " s")
