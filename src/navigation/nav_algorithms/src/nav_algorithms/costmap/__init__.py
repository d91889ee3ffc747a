"""Costmaps: the cost of being in each cell, and whether a footprint fits."""
