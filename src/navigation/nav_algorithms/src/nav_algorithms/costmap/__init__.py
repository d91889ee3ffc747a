"""Costmaps: how dear it is to stand in each cell, and whether a footprint fits."""
