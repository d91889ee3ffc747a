"""Triangles from mesh files, heightmaps, extrusions and images."""
