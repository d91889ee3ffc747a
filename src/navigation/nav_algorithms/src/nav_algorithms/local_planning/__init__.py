"""Velocities that follow a path and touch nothing, a few times a second."""
