"""Errors in a map's files; each text is one line that says what to write instead."""


class MapFileError(ValueError):
    """A map that cannot be read or written."""


class MapMissingError(MapFileError):
    """There is no such file."""


class MapMetadataError(MapFileError):
    """The YAML file is not a valid map description."""


class MapImageError(MapFileError):
    """The image is missing, damaged or too large."""
