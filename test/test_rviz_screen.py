"""The screen that nobody sees: it starts, its picture has the right size, and its colours."""

import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tools" / "makers"))
from rviz_pictures import HEIGHT_PX, WIDTH_PX, Screen, _read_xwd


def test_a_picture_of_two_rows():
    """A header with a name behind it, one entry of a colour table, and a row longer than wide."""
    fields = dict.fromkeys(range(25), 0) | {0: 104, 4: 2, 5: 2, 12: 12, 19: 1}
    pixels = bytes(range(1, 25))  # blue, green, red, unused; the third of a row is no picture
    found = _read_xwd(struct.pack(">25I", *fields.values()) + b"name" + bytes(12) + pixels)
    assert found.tolist() == [[[1, 2, 3], [5, 6, 7]], [[13, 14, 15], [17, 18, 19]]]


def test_it_starts_and_ends():
    """About 1 s."""
    with Screen() as screen:
        display = screen.environment["DISPLAY"]
        asked = subprocess.run(["xdotool", "getdisplaygeometry"], text=True, capture_output=True,
                               env={**os.environ, "DISPLAY": display}, check=True)
        assert asked.stdout.split() == [str(WIDTH_PX), str(HEIGHT_PX)]
        picture = screen.still_picture()
        assert picture.shape == (HEIGHT_PX, WIDTH_PX, 3)
        assert not np.any(picture)
    asked = subprocess.run(["xdotool", "getdisplaygeometry"], capture_output=True, check=False,
                           env={**os.environ, "DISPLAY": display})
    assert asked.returncode != 0
