"""A screen that nobody sees: Xvfb, what is on it, and the environment that draws there."""

from __future__ import annotations

import os
import struct
import subprocess
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

from run_session.failure import RunError

WIDTH_PX, HEIGHT_PX = 1200, 846  # the windows of the shipped rviz configurations
STATUS_PX = 28  # the lowest line of rviz; its frames a second are never the same
HEADER = struct.Struct(">25I")  # of an XWD file
COLOUR_BYTES = 12  # of an entry of its colour table
STEP, LIMIT = 0.4, 20.0  # s, wall, between two looks, and until the picture stands still


class Screen:
    """As a context: Xvfb runs on a free display."""

    def __enter__(self) -> Screen:
        self._folder = tempfile.TemporaryDirectory(prefix="screen-")
        reader, writer = os.pipe()
        size = f"{WIDTH_PX}x{HEIGHT_PX}x24"
        command = ["Xvfb", "-displayfd", str(writer), "-screen", "0", size, "-nocursor",
                   "-nolisten", "tcp", "-fbdir", self._folder.name]
        try:
            self._process = subprocess.Popen(command, pass_fds=[writer], stderr=subprocess.DEVNULL)
        except OSError as error:
            raise RunError(f"Xvfb cannot be started: {error.strerror}; make setup") from error
        os.close(writer)
        with os.fdopen(reader) as answer:
            self._display = f":{answer.readline().strip()}"
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.wait()
        self._folder.cleanup()

    @property
    def environment(self) -> dict[str, str]:
        """What a program needs to draw there, by the processor and so everywhere alike."""
        return {"DISPLAY": self._display, "LIBGL_ALWAYS_SOFTWARE": "1", "QT_X11_NO_MITSHM": "1",
                "XDG_RUNTIME_DIR": self._folder.name}

    def picture(self) -> np.ndarray:
        """What is on it now: (HEIGHT_PX, WIDTH_PX, 3) uint8, BGR."""
        return _read_xwd((Path(self._folder.name) / "Xvfb_screen0").read_bytes())

    def still_picture(self) -> np.ndarray:
        """The same when nothing changes any more; RunError if it never stands still."""
        until = time.monotonic() + LIMIT
        before = self.picture()
        while time.monotonic() < until:
            time.sleep(STEP)
            now = self.picture()
            if np.array_equal(now[:-STATUS_PX], before[:-STATUS_PX]):
                return now
            before = now
        raise RunError(f"the screen changed for {LIMIT:.0f} s without end")


def save(path: Path, picture: np.ndarray) -> None:
    """As PNG, small; the status line of rviz is left out."""
    cv2.imwrite(str(path), picture[:-STATUS_PX], [cv2.IMWRITE_PNG_COMPRESSION, 9])


def _read_xwd(content: bytes) -> np.ndarray:
    """Pixels of 4 bytes, blue first, as Xvfb has them at 24 bits of depth."""
    header = HEADER.unpack_from(content)
    size, width, height, row_bytes, colours = (header[i] for i in (0, 4, 5, 12, 19))
    start = size + colours * COLOUR_BYTES
    pixels = np.frombuffer(content, np.uint8, row_bytes * height, start)
    return pixels.reshape(height, row_bytes // 4, 4)[:, :width, :3].copy()
