"""Lets the tests import drawn_room, and the scripts."""

import sys
from pathlib import Path

FOLDER = Path(__file__).parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "scripts")]
