"""Tests run from a checkout that was not built, too; the lessons are modules of their folder."""

import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(PACKAGE / "src"), str(PACKAGE / "scripts")]
