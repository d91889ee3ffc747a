"""Worlds of the trials: generation, light, maps, and a robot's distance to obstacles."""
