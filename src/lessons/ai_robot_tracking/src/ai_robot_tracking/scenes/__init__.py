"""What a red cylinder does in a room, and the world files in which it does so."""
