"""The simulated house: its file, its ground, and who looks on while a robot drives in it."""
