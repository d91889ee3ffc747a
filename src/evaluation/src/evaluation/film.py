"""The video of a run: pages made from camera images, encoded as mp4."""

from __future__ import annotations

import contextlib
import os
import select
import subprocess
import tempfile
import threading
import time
from abc import abstractmethod
from collections.abc import Mapping
from pathlib import Path

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import Image

from evaluation.picture import FAINT, PAPER, bgr, write_text

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


FILM_RATE_HZ = 10
# s, simulated, between two frames: videos run at 2 times the speed, of fast drives at 8
FILM_PERIOD, FAST_FILM_PERIOD = 0.2, 0.8
VIEW_PX = (640, 360)  # width, height; a third of the camera's, which is quick to compute
BAR_PX = 44  # height of the text bar at the top
LONGEST_GAP = 30 * FILM_RATE_HZ  # frames that a pause in the camera may add to the video
LONGEST_WAIT = 1.0  # s, wall, in which no image is taken


class FilmFile:
    """Base class of all videos; subclasses draw the frames ("pages") and add them."""

    def __init__(self, path: Path):
        # An incomplete file has a name that says so, whichever process is killed.
        self._path, self._part = path, path.with_suffix(f".part{path.suffix}")
        self._ended, self._lock = threading.Event(), threading.Lock()
        self._writer: FfmpegEncoder | None = None
        self.codec = ""  # set with the first frame

    @property
    def process_id(self) -> int | None:
        """Process id of the encoder, once it was started."""
        return self._writer.process_id if self._writer else None

    def start(self) -> None:
        """Begin to record."""

    def stop(self) -> None:
        """Take no more frames."""
        self._ended.set()

    def close(self) -> str:
        """Finish the file, if any frame came; returns why it was incomplete and removed, or ""."""
        self.stop()
        fault = "interrupted"
        try:
            with self._lock:
                fault = self._writer.close() if self.codec else ""
        finally:
            if fault or not self.codec:
                if self._writer is not None:
                    self._writer.kill()
                self.codec = ""
                self._part.unlink(missing_ok=True)
            else:
                self._part.replace(self._path)
        return fault

    def _add(self, page: np.ndarray, times: int = 1) -> None:
        """Write a frame, (height, width, 3) BGR, unless the video has ended; all of one size."""
        with self._lock:
            if self._ended.is_set():
                return
            if self._writer is None:
                self._path.unlink(missing_ok=True)
                self._writer = FfmpegEncoder(self._part, *page.shape[1::-1], FILM_RATE_HZ)
            for _ in range(times):
                self._writer.write(page)
                self.codec = self._writer.codec


class CameraFilm(FilmFile):
    """Adds one image of a topic every `period` (s, simulated); works in that topic's thread.

    The callback waits until the next image is nearly due, so that most of the 190 MB that a camera
    sends in a simulated second are dropped by the publisher's queue and never copied here.
    """

    def __init__(self, path: Path, topic: str, period: float):
        super().__init__(path)
        self._topic, self._period = topic, period
        self._last: tuple[int, float] | None = None  # the last frame's number and s, wall

    @abstractmethod
    def page(self, view: np.ndarray, now: float) -> np.ndarray:
        """The frame, BGR, with the camera image (fits into VIEW_PX) at a time, s."""

    def start(self) -> None:
        """Begin to record. Starts the encoder at once: it takes seconds on a busy machine."""
        with contextlib.suppress(OSError):  # the drive goes on; the first frame tries again
            self._add(self.page(np.zeros((*VIEW_PX[::-1], 3), np.uint8), 0.0), times=0)
        # 1 MiB at a time: with the 16 MiB that a follower needs, an image took twice the time.
        rospy.Subscriber(self._topic, Image, self.take, queue_size=1, buff_size=2**20)

    def take(self, message: Image) -> None:
        """Add an image if one is due, and wait until the next one nearly is."""
        began, now = time.monotonic(), message.header.stamp.to_sec()
        number = int(now / self._period + 1e-6)  # stamps are rounded
        last, last_began = self._last or (number - 1, began)
        if self._ended.is_set() or number == last:
            return
        self._last = number, began
        from cv_bridge import CvBridge  # only here: it loads OpenCV a second time

        view = fit(CvBridge().imgmsg_to_cv2(message))
        if message.encoding == "rgb8":
            view = cv2.cvtColor(view, cv2.COLOR_RGB2BGR)
        page = self.page(view, now)
        # The video keeps simulated time even where images are missing.
        self._add(page, min(max(number - last, 1), LONGEST_GAP))
        pace = (began - last_began) / max(number - last, 1)  # s, wall, from one frame to the next
        self._ended.wait(min(max(0.0, began + 0.8 * pace - time.monotonic()), LONGEST_WAIT))


def side_by_side(view: np.ndarray | None, plan: np.ndarray, words: Mapping[int, str],
                 period: float) -> np.ndarray:
    """A frame: camera view and plan, BGR, below a text bar; `words` by their x, px."""
    height = max(VIEW_PX[1], plan.shape[0]) + BAR_PX
    page = np.full((height + height % 2, VIEW_PX[0] + plan.shape[1], 3), bgr(PAPER), np.uint8)
    for part, left, width in ((view, 0, VIEW_PX[0]), (plan, VIEW_PX[0], plan.shape[1])):
        if part is not None:
            top = BAR_PX + (height - BAR_PX - part.shape[0]) // 2
            left += (width - part.shape[1]) // 2
            page[top:top + part.shape[0], left:left + part.shape[1]] = part
    for left, text in words.items():
        write_text(page, text, (left, 29), 14)
    speed = f"film at {period * FILM_RATE_HZ:g}x"
    write_text(page, speed, (page.shape[1] - 110, 29), 12, bgr(FAINT))
    return page


def fit(image: np.ndarray) -> np.ndarray:
    """The image scaled to fit into VIEW_PX, keeping its aspect ratio."""
    height, width = image.shape[:2]
    scale = min(VIEW_PX[0] / width, VIEW_PX[1] / height)
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)
