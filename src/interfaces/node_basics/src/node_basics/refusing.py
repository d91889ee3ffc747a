"""How a program that a launch file's <param> names refuses the whole launch file."""

import os

# Its exit code, after one line that says why. roslaunch then ends without three lines about an
# invalid <param>, see launch_end.py of python_amendments.
REFUSED = os.EX_CONFIG
