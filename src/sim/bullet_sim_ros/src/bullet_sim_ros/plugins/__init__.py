"""Gazebo plugins by library file name. To add one, put a file with `@plugin(...)` here.

C++ files named here are in gazebo_plugins/src, unless another package is named.
"""

import importlib
import pkgutil


def register_plugins() -> None:
    """Import every module in this folder, each of which registers its classes."""
    for module in pkgutil.walk_packages(__path__, f"{__name__}."):
        importlib.import_module(module.name)
