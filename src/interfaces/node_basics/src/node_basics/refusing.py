"""How a program that a launch file's <param> names refuses the whole launch file."""

# Its exit code, after one line that says why; not among those of sysexits.h and of shells, which
# other programs use. roslaunch then ends without three lines about an invalid <param>, see
# launch_end.py of python_amendments.
REFUSED = 113
