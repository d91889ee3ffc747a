"""Keeps a lane by camera, and stops for people at zebra crossings."""
