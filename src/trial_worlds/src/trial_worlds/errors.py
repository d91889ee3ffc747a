"""What is wrong with a world that was asked for."""


class WorldError(Exception):
    """A file that is no world, or a world without what was asked of it; one line."""
