"""Velocities that follow a path and avoid obstacles, a few times per second."""
