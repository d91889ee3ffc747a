"""Writes pictures into an mp4: H.264 through ffmpeg where it is installed, else by OpenCV."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import cv2
import numpy as np

from run_session.processes import end_with_parent

FINISH_TIME = 1.0  # s, wall, for the encoder to end


def open_encoder(
    path: Path, width: int, height: int, rate_hz: int
) -> FfmpegEncoder | OpenCvEncoder:
    """The better encoder that this machine has; it takes pictures of (height, width, 3), BGR."""
    make = FfmpegEncoder if shutil.which("ffmpeg") else OpenCvEncoder
    return make(path, width, height, rate_hz)


class FfmpegEncoder:
    """H.264 that every player shows, through Debian's ffmpeg."""

    codec = "H.264 by ffmpeg"

    def __init__(self, path: Path, width: int, height: int, rate_hz: int):
        words = (f"nice -n 10 ffmpeg -loglevel error -y -f rawvideo -pixel_format bgr24 -video_size"
                 f" {width}x{height} -framerate {rate_hz} -i - -c:v libx264 -preset ultrafast"
                 " -crf 24 -threads 1 -pix_fmt yuv420p -movflags +faststart")
        self._process = subprocess.Popen(
            [*words.split(), str(path)], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, start_new_session=True, preexec_fn=end_with_parent)

    @property
    def process_id(self) -> int:
        return self._process.pid

    def write(self, page: np.ndarray) -> None:
        try:
            self._process.stdin.write(page.tobytes())
        except BrokenPipeError:
            return  # the film is short; the run and its score are not touched

    def close(self) -> None:
        try:
            self._process.communicate(timeout=FINISH_TIME)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


class OpenCvEncoder:
    """MPEG-4 by OpenCV itself, where there is no ffmpeg."""

    codec = "MPEG-4 by OpenCV"

    def __init__(self, path: Path, width: int, height: int, rate_hz: int):
        code = cv2.VideoWriter_fourcc(*"mp4v")
        self._writer = cv2.VideoWriter(str(path), code, rate_hz, (width, height))

    def write(self, page: np.ndarray) -> None:
        self._writer.write(page)

    def close(self) -> None:
        self._writer.release()
