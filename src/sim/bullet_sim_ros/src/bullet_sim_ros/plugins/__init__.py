"""Gazebo plugins by library file name. A file here with `@plugin(...)` is all it takes.

Files named here are those of gazebo_plugins/src, unless another package is said.
"""

import importlib
import pkgutil


def register_plugins() -> None:
    """Import every module in this folder, each of which registers its classes."""
    for module in pkgutil.walk_packages(__path__, f"{__name__}."):
        importlib.import_module(module.name)
