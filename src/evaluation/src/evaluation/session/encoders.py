"""Encodes frames as mp4: H.264 by ffmpeg if installed, else by OpenCV."""

from __future__ import annotations

import os
import select
import subprocess
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

FINISH_TIME = 20.0  # s, wall, for the encoder to finish
WRITE_TIME = 10.0  # s, wall, for it to accept a frame


class FfmpegEncoder:
    """H.264 that every player supports, by Debian's ffmpeg; frames are (height, width, 3), BGR."""

    codec = "H.264 by ffmpeg"

    def __init__(self, path: Path, width: int, height: int, rate_hz: int):
        # -xerror: otherwise a full disk at the end of the video is not reported as a failure.
        words = ("nice -n 10 ffmpeg -xerror -loglevel error -y -f rawvideo -pixel_format bgr24"
                 f" -video_size {width}x{height} -framerate {rate_hz} -i - -c:v libx264"
                 " -preset ultrafast -crf 24 -threads 1 -pix_fmt yuv420p -movflags +faststart")
        # It ends when its input does: the thread that starts it may end long before the video.
        self._said = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the object)
        self._process = subprocess.Popen(
            [*words.split(), str(path)], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
            stderr=self._said, bufsize=0, start_new_session=True)
        os.set_blocking(self._process.stdin.fileno(), False)
        self._fault = ""

    @property
    def process_id(self) -> int:
        return self._process.pid

    def write(self, page: np.ndarray) -> None:
        """Add a frame; after a failure, do nothing: the run and its score are not affected."""
        if self._fault:
            return
        pipe, rest = self._process.stdin, memoryview(page.tobytes())
        until = time.monotonic() + WRITE_TIME
        try:
            while rest:
                if not select.select([], [pipe], [], max(0.0, until - time.monotonic()))[1]:
                    self._fault = f"ffmpeg took no picture for {WRITE_TIME:g} s"
                    return
                rest = rest[os.write(pipe.fileno(), rest):]
        except BrokenPipeError:
            self._fault = self._reason()

    def close(self) -> str:
        """Finish the file; returns why it is incomplete, or "". Ctrl-C ends the encoder at once."""
        self._process.stdin.close()
        try:
            self._process.wait(FINISH_TIME)
        except subprocess.TimeoutExpired:
            self._fault = self._fault or f"ffmpeg did not end within {FINISH_TIME:g} s"
        finally:
            self.kill()
        if self._process.returncode:
            self._fault = self._fault or self._reason()
        return self._fault

    def kill(self) -> None:
        """Kill the encoder, even while another thread writes."""
        self._process.kill()
        self._process.wait()

    def _reason(self) -> str:
        """Its first line of output, which names the cause."""
        self._said.seek(0)
        return f"ffmpeg: {self._said.readline().decode(errors='replace').strip() or 'it failed'}"


class OpenCvEncoder:
    """MPEG-4 by OpenCV itself, if there is no ffmpeg."""

    codec = "MPEG-4 by OpenCV"

    def __init__(self, path: Path, width: int, height: int, rate_hz: int):
        self._path = path
        code = cv2.VideoWriter_fourcc(*"mp4v")
        self._writer = cv2.VideoWriter(str(path), code, rate_hz, (width, height))

    def write(self, page: np.ndarray) -> None:
        self._writer.write(page)

    def close(self) -> str:
        """Finish the file; returns why it is incomplete, or ""."""
        self._writer.release()
        whole = cv2.VideoCapture(str(self._path)).isOpened()
        return "" if whole else "OpenCV could not write it: is the disk full?"

    def kill(self) -> None:
        """Nothing to do: there is no process."""
