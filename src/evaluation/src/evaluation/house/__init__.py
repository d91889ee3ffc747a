"""The simulated house: its file, its ground, and the observers of a robot that drives in it."""
