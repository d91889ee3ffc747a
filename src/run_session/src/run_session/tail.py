"""Files that another process writes, read while they grow."""

from __future__ import annotations

from pathlib import Path


class Tail:
    """Complete new lines of a file that grows."""

    def __init__(self, path: Path):
        self.path, self.read, self._rest = path, 0, b""  # bytes read

    def lines(self) -> list[str]:
        """The lines since the last call; none if there is no file."""
        try:
            with self.path.open("rb") as file:
                file.seek(self.read)
                data = file.read()
        except FileNotFoundError:
            return []
        self.read += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [line.decode("utf-8", "replace") for line in lines]

    def skip(self) -> None:
        """Skip the lines that are there."""
        self.lines()
