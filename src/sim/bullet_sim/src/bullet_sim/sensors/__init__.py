"""Sensors only read the world: each returns a frozen reading."""
