#!/usr/bin/env python3
"""`rosrun lane_keeping make_lane.py` under its former name."""

import os
import sys

os.execvp("rosrun", ["rosrun", "lane_keeping", "make_lane.py", *sys.argv[1:]])
