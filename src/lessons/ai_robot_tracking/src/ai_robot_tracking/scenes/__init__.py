"""Scenes with a red cylinder that moves in a room, and their world files."""
