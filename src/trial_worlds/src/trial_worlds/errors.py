"""The error for invalid worlds."""


class WorldError(Exception):
    """A file is not a world, or the world lacks what is needed; one line."""
