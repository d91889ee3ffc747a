"""Rendering of the scene: one protocol, one module per backend."""
