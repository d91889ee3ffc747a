#!/usr/bin/env python3
"""`rosrun learning_topic make_course.py` under its former name."""

import os
import sys

os.execvp("rosrun", ["rosrun", "learning_topic", "make_course.py", *sys.argv[1:]])
