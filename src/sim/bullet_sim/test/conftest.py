"""Lets the tests import prop_models.py, rigs.py and snapshots.py beside them."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
