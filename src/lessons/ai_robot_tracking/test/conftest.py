"""Lets the tests import drawn_room."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
