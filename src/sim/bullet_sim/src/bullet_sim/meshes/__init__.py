"""Triangles: of mesh files, heightmaps, extrusions and pictures."""
