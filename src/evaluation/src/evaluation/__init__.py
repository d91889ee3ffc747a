"""Courses, and the trials that drive on them and score the drives; `start.py` lists them."""
