#!/usr/bin/env python3
"""`rosrun trial_worlds draw_map.py` under its former name."""

import os
import sys

os.execvp("rosrun", ["rosrun", "trial_worlds", "draw_map.py", *sys.argv[1:]])
