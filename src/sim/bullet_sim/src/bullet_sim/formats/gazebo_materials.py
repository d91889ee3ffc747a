"""Gazebo's named materials, such as `Gazebo/Grey`, read from a table in data/."""

import tomllib
from functools import cache

from bullet_sim.description import Material
from bullet_sim.formats.resources import DATA_FOLDER


@cache
def named_materials() -> dict[str, Material]:
    """All materials by full name."""
    table = tomllib.loads((DATA_FOLDER / "gazebo_materials.toml").read_text(encoding="utf-8"))
    return {name: Material(**{key: tuple(value) if isinstance(value, list) else value
                              for key, value in entry.items()}) for name, entry in table.items()}
