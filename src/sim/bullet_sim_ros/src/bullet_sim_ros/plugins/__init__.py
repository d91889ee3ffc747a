"""Gazebo plugins by library file name. A file here with `@plugin(...)` is all it takes.

"Upstream" is the file of the library's name in gazebo_plugins/src: that of
libgazebo_ros_laser.so is gazebo_ros_laser.cpp.
"""

import importlib
import pkgutil


def register_plugins() -> None:
    """Import every module in this folder, each of which registers its classes."""
    for module in pkgutil.walk_packages(__path__, f"{__name__}."):
        importlib.import_module(module.name)
