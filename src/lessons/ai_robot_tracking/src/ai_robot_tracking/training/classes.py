"""The shipped detector's classes, in the order of the network's outputs."""

from __future__ import annotations

CLASSES = ("person", "cylinder", "cone", "stop sign", "traffic light")
