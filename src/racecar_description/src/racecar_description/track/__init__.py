"""Custom race tracks: from a drawing, a centre line or a seed to a world to drive in.

Everything is in m, x right and y up, angles counter-clockwise. The drawing's frame has its origin
in the picture's lower left corner; the world's is where a lap starts (see `course.py`).
"""
