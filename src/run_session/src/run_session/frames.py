"""Counts the camera's images and the commands sent in answer."""

from __future__ import annotations

import bisect

from geometry_msgs.msg import Twist
from sensor_msgs.msg import CameraInfo

UNANSWERED_SAYS = "lockstep: no message on"  # in the simulator's warning, at most every 10 s


class FrameCount:
    """Images are counted by header.seq, so that one missed here counts as well.

    In lockstep they count from the first one, because the follower runs from the beginning;
    otherwise from the one that its first command answers.
    """

    def __init__(self, lockstep: bool):
        self._lockstep = lockstep
        self._first: int | None = None  # header.seq
        self._numbers: list[int] = []  # header.seq of each image
        self._times: list[float] = []  # s, simulated
        self.commands = 0

    def count_frame(self, message: CameraInfo) -> None:
        """Count one more image, by its CameraInfo, which is smaller."""
        if self._lockstep and self._first is None:
            self._first = message.header.seq
        self._numbers.append(message.header.seq)
        self._times.append(message.header.stamp.to_sec())

    def count_command(self, _message: Twist) -> None:
        """Count one more command; a follower sends one for each image."""
        if self._first is None and self._numbers:
            self._first = self._numbers[-1]
        self.commands += 1

    def sent(self, until: float) -> int:
        """Number of images that count, stamped up to this simulated time (s)."""
        seen = bisect.bisect_right(self._times, until)
        if self._first is None or not seen:
            return 0
        return max(0, self._numbers[seen - 1] - self._first + 1)

    def later_than(self, time: float) -> bool:
        """Whether an image after this simulated time (s) has arrived, and so all before it."""
        return bool(self._times) and self._times[-1] > time


def frame_figures(sent: int, commands: int, lockstep_log: list[str] | None) -> dict:
    """Images sent, answered and dropped.

    A follower answers each image with one command, so images without a command were dropped in
    transit or by the follower. In lockstep (when the run's log is given) all are answered, unless
    the simulator logged that it went on without an answer.
    """
    dropped = max(sent - commands, 0)
    if lockstep_log is not None:
        went_on = any(UNANSWERED_SAYS in line for line in lockstep_log)
        dropped = max(dropped, 1) if went_on else 0
    return {"frames_sent": sent, "frames_answered": sent - dropped, "frames_dropped": dropped}
