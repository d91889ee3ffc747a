"""The file of a film: it begins with the first page and takes no more once it is ended."""

from __future__ import annotations

import threading
from pathlib import Path

import cv2
import numpy as np

from evaluation.session.encoders import FfmpegEncoder, OpenCvEncoder, open_encoder

FILM_RATE_HZ = 10
# s, simulated, between two pictures of the film, which so runs at 2 or 8 times the speed
FILM_PERIOD = 0.2
FAST_FILM_PERIOD = 0.8  # the same where simulated time runs several times faster than real time
VIEW_PX = (640, 360)  # width, height; a third of the camera's, which is quick to make


class FilmFile:
    """What all films share; those that film a drive draw its pages and add them."""

    def __init__(self, path: Path):
        self._path = path
        self._ended, self._lock = threading.Event(), threading.Lock()
        self._writer: FfmpegEncoder | OpenCvEncoder | None = None
        self.codec = ""

    @property
    def process_id(self) -> int | None:
        """Of the encoder, if it is a process."""
        return getattr(self._writer, "process_id", None)

    def stop(self) -> None:
        """Take no more pictures."""
        self._ended.set()

    def close(self) -> None:
        """Finish the file, if any picture came."""
        self.stop()
        with self._lock:
            if self._writer is not None:
                self._writer.close()

    def _add(self, page: np.ndarray, times: int = 1) -> None:
        """Write a page, (height, width, 3) BGR, unless the film has ended; all of one size."""
        with self._lock:
            if self._ended.is_set():
                return
            if self._writer is None:
                self._path.unlink(missing_ok=True)
                height, width, _ = page.shape
                self._writer = open_encoder(self._path, width, height, FILM_RATE_HZ)
                self.codec = self._writer.codec
            for _ in range(times):
                self._writer.write(page)


def fit(image: np.ndarray) -> np.ndarray:
    """The image made to fit into VIEW_PX, in its own proportions."""
    height, width = image.shape[:2]
    scale = min(VIEW_PX[0] / width, VIEW_PX[1] / height)
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)
