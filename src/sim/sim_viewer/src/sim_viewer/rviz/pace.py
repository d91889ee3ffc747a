"""How much is sent to a page: one frame at a time, and no more points than it draws in time."""

FEWEST, MOST = 10_000, 200_000  # points
SLOW, QUICK = 0.5, 0.2  # s from sending a frame until it is drawn
LESS, MORE = 0.5, 1.25  # by how much the number of points changes then


class Pace:
    """The pace of one display; times are in s of a monotonic clock."""

    def __init__(self) -> None:
        self.most_points = MOST
        self._number = 0
        self._sent: float | None = None  # when the frame being drawn was sent
        self._large = False

    @property
    def free(self) -> bool:
        """Whether the page has drawn the last frame."""
        return self._sent is None

    def sent(self, points: int, now: float) -> int:
        """A frame with so many points is sent; returns its number."""
        self._number += 1
        self._sent, self._large = now, points >= self.most_points / 2
        return self._number

    def drawn(self, number: int, now: float) -> bool:
        """The page has drawn a frame; returns whether it is the one that was sent last."""
        if self._sent is None or number != self._number:
            return False
        took, self._sent = now - self._sent, None
        if self._large and took > SLOW:
            self.most_points = max(FEWEST, round(self.most_points * LESS))
        elif self._large and took < QUICK:
            self.most_points = min(MOST, round(self.most_points * MORE))
        return True
