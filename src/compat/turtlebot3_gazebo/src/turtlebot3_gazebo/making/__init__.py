"""Makes this package's worlds, models and textures: the same numbers, the same bytes."""
