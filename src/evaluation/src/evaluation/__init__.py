"""The course, how a drive round it is scored, and the run that does both."""
