#!/usr/bin/env python3
"""`rosrun ai_robot_tracking make_tracking_world.py` under its former name."""

import os
import sys

os.execvp("rosrun", ["rosrun", "ai_robot_tracking", "make_tracking_world.py", *sys.argv[1:]])
